#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "call/argument.h"
#include "call/define.h"
#include "call/faults.h"
#include "call/run_job.h"
#include "echopath/label/expressions/expression.h"
#include "label/named_selections.h"
#include "values/array.h"

namespace echopath::bindings {
namespace {

// Text becomes a Selection wherever one is asked for. Unlike py::implicitly_convertible, which would turn a fault in
// the text into "incompatible arguments", this lets the message with the caret through.
PyObject* selection_of_text(PyObject* value, PyTypeObject* selection_type) {
  if (!PyUnicode_Check(value)) return nullptr;
  if (PyUnicode_AsUTF8AndSize(value, nullptr) == nullptr) {  // or it would be asked for again and again
    forget_fault();
    PyErr_Format(PyExc_ValueError, "text: must be text without lone surrogates, got %A", value);
    throw py::error_already_set();
  }
  PyObject* made = PyObject_CallOneArg(reinterpret_cast<PyObject*>(selection_type), value);
  if (made == nullptr) throw py::error_already_set();
  return made;
}

// Paths are bound after selections, so their name is written out.
struct Record : Instance<std::shared_ptr<Paths>> {
  static constexpr auto type_name = py::detail::const_name("echopath._core.Paths");
};

py::array_t<bool> matches_of(const Selection& selection, Arg<"paths", Record> paths) {
  const std::vector<uint8_t> taken =
      run_job("matches", py::none(), [&](Job& job) { return selection.matches(**paths, &job); });
  py::array_t<bool> mask(std::ssize(taken));
  std::ranges::copy(taken, mask.mutable_data());
  return mask;
}

py::tuple partition_groups(const Paths& paths, const SelectionPairs& parts) {
  Partition partition =
      run_job("partition", py::none(), [&](Job& job) { return make_partition(paths, named_selections(parts), &job); });
  return py::make_tuple(partition.names, numpy_take(std::move(partition.group)));
}

// Power of a path, to be compared with powers in W.
struct Power {};

// Refuses what else stands beside & or |: these bind tighter than comparisons, so that Python reads
// `a & ep.num_bounces == 1` as `(a & ep.num_bounces) == 1`.
[[noreturn]] void refuse_beside_operator(const char* argument, py::handle value) {
  refuse_type(argument,
              "what they join is a Selection or its text, and a comparison stands in parentheses, as in ep.hits('wall') & "
              "(ep.num_bounces == 1)",
              value);
}

struct Operand : SelectionOrText {
  static Selection from(py::handle value, const char* argument) {
    if (!py::isinstance<Selection>(value) && !PyUnicode_Check(value.ptr())) refuse_beside_operator(argument, value);
    return SelectionOrText::from(value, "text");
  }
};

using Joined = Arg<"& and |", Operand>;

// Lets what is compared say so, too, where no Selection is beside & or |: `ep.power > 1e-15 & ep.num_bounces == 2`.
template <class Type>
void refuse_operators(py::class_<Type>& type) {
  for (const char* method : {"__and__", "__or__", "__rand__", "__ror__"}) {
    type.def(method, [](const py::object& self, const py::object&) { refuse_beside_operator("& and |", self); });
  }
}

void check_globs(const Selection& selection, Arg<"scene", Instance<std::shared_ptr<Scene>>> scene) {
  selection.check_globs((*scene)->all_mesh_names());
}

// Number of hits of a path, to be compared with whole numbers.
struct NumBounces {};

constexpr int64_t kUnlimited = std::numeric_limits<int64_t>::max();

// What the two are compared with; errors name them as they are written.
using BounceCount = Arg<"ep.num_bounces is compared with a count", Whole<std::numeric_limits<int64_t>::min(), kUnlimited>>;
using Watts = Arg<"ep.power is compared with a power in W", Number>;

// Any whole number is a fair question; beyond the longest path the answer is no path or every path.

Selection between(int64_t min, int64_t max) {
  const int64_t low = std::max<int64_t>(min, 0);
  if (low > max || low > kMaxRepeatCount) return ~Selection::num_bounces(0);
  const auto limit = max > kMaxRepeatCount ? std::nullopt : std::optional(static_cast<int>(max));
  return Selection::num_bounces(static_cast<int>(low), limit);
}

[[noreturn]] void refuse_truth(const char* what) {
  throw py::type_error(std::string(what) +
                       " has no truth value: combine with & | ~ instead of and, or, not, and write (2 <= "
                       "ep.num_bounces) & (ep.num_bounces <= 4) instead of 2 <= ep.num_bounces <= 4");
}

[[noreturn]] void refuse_equality() {
  throw py::type_error("ep.power is a measured quantity: compare it by < <= > or >= with a power in W");
}

void bind_selection(py::module_& m) {
  py::class_<Selection> selection(m, "Selection", R"(Which paths are meant: path expressions joined by & | ~.

text: path expressions, and power > 1e-15 (W, at the trace time for the first antennas; also < <= >=), joined by
    ~ (not, binds tightest), & (and), | (or) and parentheses. A path expression is a regular expression over the hits of a
    path between T and R. A hit is . (any), 'glob' (a mesh, by its full name or that of a group above it), S, D or E (specular,
    diffuse, a point on a sharp edge), S'glob', ['a*' 'b'] or [^ 'a*']; operators are * + ? | ( ) {m,n}.
    Instead, another Selection to copy.
Text stands wherever a Selection is asked for. Raises ValueError with a caret under the fault; matching raises one when a glob
takes no mesh of the scene.)");
  define_init(selection, [](Arg<"text", SelectionOrText> text) { return Selection(*text); }, py::arg("text"));
  define(selection, "matches", &matches_of, py::arg("paths"),
         "Bool [P]: which of the paths are selected. Raises TypeError naming the argument, ValueError for names that no "
         "mesh has.");
  define(selection, "check", &check_globs, py::arg("scene"),
         "Raises ValueError naming near meshes where a glob takes no mesh of `scene`: to know before a long trace.");
  selection.def_property_readonly("text", &Selection::text, "as written; joined ones as (T . R) & ~(T . . R)")
      .def("__and__", [](const Selection& a, const Joined& b) { return a & *b; })
      .def("__rand__", [](const Selection& a, const Joined& b) { return *b & a; })
      .def("__or__", [](const Selection& a, const Joined& b) { return a | *b; })
      .def("__ror__", [](const Selection& a, const Joined& b) { return *b | a; })
      .def("__invert__", [](const Selection& a) { return ~a; })
      .def("__bool__", [](const Selection&) -> bool { refuse_truth("a Selection"); })
      .def("__eq__",
           [](const Selection& self, const py::object& other) {
             return py::isinstance<Selection>(other) && self.text() == other.cast<const Selection&>().text();
           })
      .def("__hash__", [](const Selection& self) { return py::hash(py::str(self.text())); })
      .def(py::pickle([](const Selection& self) { return py::str(self.text()); },
                      [](const py::str& text) { return Selection(text.cast<std::string>()); }))
      .def("__str__", &Selection::text)
      .def("__repr__", [](const Selection& self) { return "<Selection " + self.text() + ">"; });
  py::detail::get_type_info(typeid(Selection))->implicit_conversions.push_back(&selection_of_text);
  m.def("hits", [](const std::string& glob) { return Selection::touches(glob); }, py::arg("glob"), "What ep.hits calls.");
  m.def("first", [](const std::string& glob) { return Selection::first(glob); }, py::arg("glob"), "What ep.first calls.");
  m.def("last", [](const std::string& glob) { return Selection::last(glob); }, py::arg("glob"), "What ep.last calls.");
}

void bind_num_bounces(py::module_& m) {
  py::class_<NumBounces> type(m, "NumBounces", "The number of hits of a path: ep.num_bounces >= 2 is a Selection.");
  type.def("__eq__", [](const NumBounces&, BounceCount count) { return between(*count, *count); })
      .def("__ne__", [](const NumBounces&, BounceCount count) { return ~between(*count, *count); })
      .def("__ge__", [](const NumBounces&, BounceCount count) { return between(*count, kUnlimited); })
      .def("__gt__", [](const NumBounces&, BounceCount count) { return ~between(0, *count); })
      .def("__lt__", [](const NumBounces&, BounceCount count) { return ~between(*count, kUnlimited); })
      .def("__le__", [](const NumBounces&, BounceCount count) { return between(0, *count); })
      .def("__bool__", [](const NumBounces&) -> bool { refuse_truth("ep.num_bounces"); })
      .def("__reduce__", [](const NumBounces&) { return "num_bounces"; })  // of this module, itself
      .def("__repr__", [](const NumBounces&) { return "ep.num_bounces"; });
  refuse_operators(type);
  m.attr("num_bounces") = NumBounces{};
}

Selection power(Selection::Comparison comparison, double watts) { return Selection::power(comparison, watts); }

void bind_power(py::module_& m) {
  using Comparison = Selection::Comparison;
  py::class_<Power> type(m, "Power",
                         R"(The power of a path in W, at the trace time for the first antennas of the radar that traced.

ep.power > 1e-15 is a Selection; `paths.power` has the values.)");
  type.def("__lt__", [](const Power&, Watts watts) { return power(Comparison::kBelow, *watts); })
      .def("__le__", [](const Power&, Watts watts) { return power(Comparison::kAtMost, *watts); })
      .def("__gt__", [](const Power&, Watts watts) { return power(Comparison::kAbove, *watts); })
      .def("__ge__", [](const Power&, Watts watts) { return power(Comparison::kAtLeast, *watts); })
      .def("__eq__", [](const Power&, const py::object&) -> bool { refuse_equality(); })
      .def("__ne__", [](const Power&, const py::object&) -> bool { refuse_equality(); })
      .def("__bool__", [](const Power&) -> bool { refuse_truth("ep.power"); })
      .def("__reduce__", [](const Power&) { return "power"; })
      .def("__repr__", [](const Power&) { return "ep.power"; });
  refuse_operators(type);
  m.attr("power") = Power{};
}

}  // namespace

void bind_label(py::module_& m) {
  bind_selection(m);
  bind_power(m);
  bind_num_bounces(m);
  m.def(
      "check_part_names", [](const SelectionPairs& parts) { check_part_names(named_selections(parts)); }, py::arg("parts"),
      "Raises ValueError where a name of [(name, selection), ...] is empty, \"other\" or given twice.");
  m.def("partition_groups", &partition_groups, py::arg("paths"), py::arg("parts"),
        R"(The part of each path in a partition.

parts: [(name, selection), ...]; the first that takes a path has it
Returns the names with "other" last, and uint32 [P], indices into them. Raises ValueError for names that are empty,
"other" or given twice.)");
}

}  // namespace echopath::bindings
