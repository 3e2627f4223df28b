#include "call/argument.h"

#include <cmath>

#include "call/faults.h"

namespace echopath::bindings::detail {
namespace {

constexpr double kTwoTo63 = 9223372036854775808.0;

std::string with_article(const std::string& noun) {
  return (std::string("AEIOU").find(noun[0]) == std::string::npos ? "a " : "an ") + noun;
}

std::string name_of(py::handle type) { return py::cast<std::string>(type.attr("__name__")); }

// "a Motion (LinearMotion, KeyframeMotion)": the class, and what may stand for it.
std::string any_of(py::handle type) {
  std::string names;
  for (const py::handle each : py::list(type.attr("__subclasses__")())) names += (names.empty() ? "" : ", ") + name_of(each);
  return with_article(name_of(type)) + (names.empty() ? "" : " (" + names + ")");
}

bool is_numpy(py::handle value) { return has_attribute(value, "dtype"); }

bool is_bool(py::handle value) {
  if (PyBool_Check(value.ptr())) return true;
  const py::array array = is_numpy(value) ? array_or_none(value) : py::reinterpret_steal<py::array>(py::handle());
  return array && array.dtype().kind() == 'b';
}

// The whole number that a float stands for.
std::optional<int64_t> whole_of(double number) {
  if (!(std::abs(number) < kTwoTo63) || number != std::floor(number)) return std::nullopt;
  return static_cast<int64_t>(number);
}

// None where it does not fit 64 bits.
std::optional<int64_t> whole_of(const py::object& integer) {
  int overflow = 0;
  const int64_t number = PyLong_AsLongLongAndOverflow(integer.ptr(), &overflow);
  return overflow == 0 ? std::optional<int64_t>(number) : std::nullopt;
}

// What Python itself takes as a real number; an empty object, and no error, where there is none.
py::object as_float(py::handle value) {
  const PyNumberMethods* number = Py_TYPE(value.ptr())->tp_as_number;
  const bool has_value = number != nullptr && (number->nb_float != nullptr || number->nb_index != nullptr);
  if (!has_value || is_bool(value) || PyComplex_Check(value.ptr())) return py::object();
  if (is_numpy(value)) {
    const py::array array = array_or_none(value);
    const bool is_real = array && std::string_view("iuf").find(array.dtype().kind()) != std::string_view::npos;
    if (!is_real || array.ndim() != 0) return py::object();
  }
  py::object result = py::reinterpret_steal<py::object>(PyNumber_Float(value.ptr()));
  if (!result) forget_fault();
  return result;
}

}  // namespace

double checked_number(py::handle value, const char* argument) {
  if (PyLong_Check(value.ptr()) && !PyBool_Check(value.ptr())) {
    const double number = PyLong_AsDouble(value.ptr());
    if (number != -1.0 || !PyErr_Occurred()) return number;
    forget_fault();
    refuse_value(argument, "must be a number of at most 1.8e308", value);
  }
  const py::object number = as_float(value);
  if (!number) refuse_type(argument, "must be a number", value);
  return PyFloat_AS_DOUBLE(number.ptr());
}

double checked_real(py::handle value, const char* argument) {
  const double real = checked_number(value, argument);
  if (!std::isfinite(real)) refuse_value(argument, "must be finite", value);
  return real;
}

uint64_t checked_seed(py::handle value, const char* argument) {
  constexpr const char* kRule = "must be a whole number from 0 to 18446744073709551615";
  if (!PyIndex_Check(value.ptr()) || is_bool(value)) {
    return static_cast<uint64_t>(checked_whole(value, argument, 0, std::numeric_limits<int64_t>::max()));
  }
  const py::object integer = py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr()));
  if (integer) {
    const unsigned long long seed = PyLong_AsUnsignedLongLong(integer.ptr());
    if (!PyErr_Occurred()) return seed;
  }
  forget_fault();
  if (!integer) refuse_type(argument, kRule, value);
  refuse_value(argument, kRule, value);
}

int64_t checked_whole(py::handle value, const char* argument, int64_t low, int64_t high) {
  using Limits = std::numeric_limits<int64_t>;
  std::string rule = "must be a whole number";
  if (low > Limits::min() || high < Limits::max()) rule += " from " + std::to_string(low) + " to " + std::to_string(high);
  std::optional<int64_t> whole;
  if (PyIndex_Check(value.ptr()) && !is_bool(value)) {
    const py::object integer = py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr()));
    if (!integer) {
      forget_fault();
      if (!is_numpy(value)) refuse_type(argument, rule, value);
    } else {
      whole = whole_of(integer);
      if (whole && *whole >= low && *whole <= high) return *whole;
      refuse_value(argument, rule, value);
    }
  }
  const py::object number = as_float(value);
  if (!number) refuse_type(argument, rule, value);
  whole = whole_of(PyFloat_AS_DOUBLE(number.ptr()));
  if (!whole || *whole < low || *whole > high) refuse_value(argument, rule, value);
  return *whole;
}

bool checked_flag(py::handle value, const char* argument) {
  if (PyBool_Check(value.ptr())) return value.ptr() == Py_True;
  if (is_bool(value)) {
    const py::array array = array_or_none(value);
    if (array.ndim() == 0) return *py::array_t<bool>(array).data();
  }
  refuse_type(argument, "must be True or False", value);
}

std::string checked_text(py::handle value, const char* argument) {
  if (!PyUnicode_Check(value.ptr())) refuse_type(argument, "must be text", value);
  Py_ssize_t size = 0;
  const char* text = PyUnicode_AsUTF8AndSize(value.ptr(), &size);
  if (text == nullptr) {
    forget_fault();
    refuse_value(argument, "must be text that UTF-8 can hold, without lone surrogates", value);
  }
  const std::string taken(text, static_cast<size_t>(size));
  if (taken.find('\0') != std::string::npos) refuse_value(argument, "must be text without the character NUL", value);
  return taken;
}

std::vector<py::object> checked_items(py::handle value, const char* argument) {
  const bool is_other = PyUnicode_Check(value.ptr()) || PyBytes_Check(value.ptr()) || PyDict_Check(value.ptr());
  const py::object fast =
      is_other ? py::object() : py::reinterpret_steal<py::object>(PySequence_Fast(value.ptr(), "not a sequence"));
  if (!fast) {
    forget_fault();
    refuse_type(argument, "must be a list", value);
  }
  std::vector<py::object> items;
  for (Py_ssize_t i = 0; i < PySequence_Fast_GET_SIZE(fast.ptr()); ++i) {
    items.push_back(py::reinterpret_borrow<py::object>(PySequence_Fast_GET_ITEM(fast.ptr(), i)));
  }
  return items;
}

void refuse_instance(py::handle type, const char* argument, py::handle value) {
  refuse_type(argument, "must be " + any_of(type), value);
}

}  // namespace echopath::bindings::detail
