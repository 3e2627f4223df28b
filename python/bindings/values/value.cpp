#include "values/value.h"

#include <pybind11/numpy.h>

#include "call/faults.h"

namespace echopath::bindings::detail {
namespace {

namespace py = pybind11;

bool same(py::handle one, py::handle other) {
  const bool is_array = py::isinstance<py::array>(one);
  if (is_array != py::isinstance<py::array>(other)) return false;
  if (!is_array) return one.equal(other);
  return py::module_::import("numpy").attr("array_equal")(one, other).cast<bool>();
}

// What equal values have in common, and can be hashed. The sum turns -0.0 into 0.0, which equals it.
py::object hashable(py::handle value) {
  if (py::isinstance<py::array>(value)) return (value + py::int_(0)).attr("tobytes")();
  if (py::isinstance<py::list>(value)) return py::tuple(py::reinterpret_borrow<py::object>(value));
  return py::reinterpret_borrow<py::object>(value);
}

}  // namespace

py::dict attributes_of(const py::object& self, const std::vector<std::string>& names) {
  py::dict found;
  for (const std::string& name : names) {
    if (py::hasattr(self, name.c_str())) found[name.c_str()] = self.attr(name.c_str());
  }
  return found;
}

bool same_values(const py::dict& one, const py::dict& other) {
  if (one.size() != other.size()) return false;
  for (const auto& [name, value] : one) {
    if (!other.contains(name) || !same(value, other[name])) return false;
  }
  return true;
}

py::ssize_t hash_of_values(const py::dict& keywords) {
  py::list values;
  for (const auto& [name, value] : keywords) values.append(hashable(value));
  return py::hash(py::tuple(values));
}

py::object remade(const py::object& make, const py::dict& keywords, const py::dict& changes) {
  py::dict all;
  for (const auto& [name, value] : keywords) all[name] = value;
  for (const auto& [name, value] : changes) all[name] = value;
  return make(**all);
}

py::object state_of(const py::object& self, const py::dict& keywords) {
  const py::object own = py::getattr(self, "__dict__", py::dict());
  if (py::len(own) == 0) return keywords;
  return py::make_tuple(keywords, own.attr("copy")());
}

std::pair<py::dict, py::dict> checked_state(const py::object& state, const char* type_name) {
  const std::string rule = std::string("must be a dict of the arguments of ") + type_name;
  py::object keywords = state;
  py::dict own;
  if (PyTuple_Check(state.ptr()) && py::len(state) == 2) {
    const py::tuple both = state;
    if (!PyDict_Check(both[1].ptr()))
      refuse_type("state", rule + ", alone or with a dict of what is the object's own", state);
    keywords = both[0];
    own = both[1];
  }
  if (!PyDict_Check(keywords.ptr())) refuse_type("state", rule, keywords);
  for (const auto& [name, value] : py::reinterpret_borrow<py::dict>(keywords)) {
    if (!PyUnicode_Check(name.ptr())) refuse_type("state", rule, name);
  }
  return {py::reinterpret_borrow<py::dict>(keywords), own};
}

void refuse_change(py::handle self, py::handle name, py::handle value) {
  if (PyObject_GenericSetAttr(self.ptr(), name.ptr(), value.ptr()) == 0) return;
  forget_fault();
  const std::string of = py::cast<std::string>(py::type::handle_of(self).attr("__name__")), called = escaped(name);
  throw py::attribute_error(called + ": cannot be set, a " + of + " does not change; replace(" + called +
                            "=...) returns a copy that differs");
}

}  // namespace echopath::bindings::detail
