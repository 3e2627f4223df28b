#pragma once
// Arguments that are checked as they come in. A function that is bound takes
//
//   Arg<"num_samples", Count> num_samples
//
// and reads the checked value as *num_samples. A wrong value raises TypeError (another kind of value) or ValueError (not
// allowed), and the message names the argument, the rule and the value. help() shows the plain type of the kind.
//
//   Real, Complex, Whole<low, high>, Count, Positive   numbers; whole floats such as 1e5 will do for whole numbers
//   Number, Seed                                       numbers that may be infinite or NaN; whole numbers below 2^64
//   Flag, Text, OneOf<choice>                          True or False, str, one of the names of choice.h
//   Vector3, Points, Triangles, Matrix, ...            arrays of array.h; lists and tuples of numbers will do
//   Instance<T>, Instance<std::shared_ptr<T>>          an object of a bound class T
//   Optional<Kind>, List<Kind>                         or None; a list, tuple or other sequence
//
// A kind has the type Value, its `type_name` in signatures, and `from`, which checks. Functions with such arguments are
// bound by `define` and `define_init` (define.h), which also name missing, unknown and surplus arguments.
#include <pybind11/complex.h>
#include <pybind11/pybind11.h>

#include <complex>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "call/leaving.h"
#include "call/shown.h"
#include "values/array.h"
#include "values/choice.h"

namespace echopath::bindings {

// Text as a template argument.
template <size_t N>
struct Literal {
  char text[N] = {};
  consteval Literal(const char (&from)[N]) { std::copy_n(from, N, text); }
};

template <Literal kName, class Kind>
class Arg {
 public:
  using Value = typename Kind::Value;
  Arg() = default;
  explicit Arg(Value value) : value_(std::move(value)) {}
  static constexpr const char* name() { return kName.text; }
  const Value& operator*() const { return *value_; }
  const Value* operator->() const { return &*value_; }

 private:
  std::optional<Value> value_;  // empty before the call
};

namespace detail {

double checked_number(py::handle value, const char* argument);
double checked_real(py::handle value, const char* argument);  // finite
uint64_t checked_seed(py::handle value, const char* argument);
int64_t checked_whole(py::handle value, const char* argument, int64_t low, int64_t high);  // low to high
bool checked_flag(py::handle value, const char* argument);
std::string checked_text(py::handle value, const char* argument);  // encodable, without NUL
std::vector<py::object> checked_items(py::handle value, const char* argument);
[[noreturn]] void refuse_instance(py::handle type, const char* argument, py::handle value);

template <class T>
struct BoundClass {
  using Type = T;
};
template <class T>
struct BoundClass<std::shared_ptr<T>> {
  using Type = T;
};

}  // namespace detail

struct Real {
  using Value = double;
  static constexpr auto type_name = py::detail::const_name("float");
  static double from(py::handle value, const char* argument) { return detail::checked_real(value, argument); }
};

struct Number {
  using Value = double;
  static constexpr auto type_name = py::detail::const_name("float");
  static double from(py::handle value, const char* argument) { return detail::checked_number(value, argument); }
};

struct Seed {
  using Value = uint64_t;
  static constexpr auto type_name = py::detail::const_name("int");
  static uint64_t from(py::handle value, const char* argument) { return detail::checked_seed(value, argument); }
};

struct Complex {
  using Value = std::complex<double>;
  static constexpr auto type_name = py::detail::const_name("complex");
  static Value from(py::handle value, const char* argument) { return *checked_array<Value>(value, argument, "[]").data(); }
};

template <int64_t kLow, int64_t kHigh>
struct Whole {
  using Value =
      std::conditional_t<kLow >= std::numeric_limits<int>::min() && kHigh <= std::numeric_limits<int>::max(), int, int64_t>;
  static constexpr auto type_name = py::detail::const_name("int");
  static Value from(py::handle value, const char* argument) {
    return static_cast<Value>(detail::checked_whole(value, argument, kLow, kHigh));
  }
};
using Count = Whole<0, std::numeric_limits<int>::max()>;
using Positive = Whole<1, std::numeric_limits<int>::max()>;

struct Flag {
  using Value = bool;
  static constexpr auto type_name = py::detail::const_name("bool");
  static bool from(py::handle value, const char* argument) { return detail::checked_flag(value, argument); }
};

struct Text {
  using Value = std::string;
  static constexpr auto type_name = py::detail::const_name("str");
  static std::string from(py::handle value, const char* argument) { return detail::checked_text(value, argument); }
};

// kChoice: a constexpr Choice at namespace scope
template <const auto& kChoice>
struct OneOf {
  using Value = decltype(kChoice.value_of({}));
  static constexpr auto type_name = py::detail::const_name("str");
  static Value from(py::handle value, const char* argument) {
    const auto found = PyUnicode_Check(value.ptr()) ? kChoice.find(escaped(value)) : std::nullopt;
    if (found) return *found;
    const std::string rule = "must be " + kChoice.listed();
    if (PyUnicode_Check(value.ptr())) refuse_value(argument, rule, value);
    refuse_type(argument, rule, value);
  }
};

// A kind that `kFrom` of array.h checks.
template <auto kFrom>
struct ArrayKind {
  using Value = std::invoke_result_t<decltype(kFrom), py::handle, std::string_view>;
  static constexpr auto type_name = py::detail::const_name("ArrayLike");
  static Value from(py::handle value, const char* argument) { return kFrom(value, argument); }
};
using Vector3 = ArrayKind<&as_vec3>;                 // [3], finite
using Points = ArrayKind<&as_points>;                // [N, 3]
using Frames = ArrayKind<&as_frames>;                // [T, V, 3]
using Triangles = ArrayKind<&as_triangles>;          // [F, 3], indices
using Matrix = ArrayKind<&as_transform>;             // [4, 4], last row 0 0 0 1
using UnitQuaternion = ArrayKind<&as_quaternion>;    // [4] (w, x, y, z)
using UnitQuaternions = ArrayKind<&as_quaternions>;  // [N, 4]

// A NumPy array of T of that shape, "[E, A]".
template <class T, Literal kShape>
struct Array {
  using Value = py::array_t<T, py::array::c_style>;
  static constexpr auto type_name = py::detail::const_name("ArrayLike");
  static Value from(py::handle value, const char* argument) { return checked_array<T>(value, argument, kShape.text); }
};

template <class T, Literal kShape = "[N]">
struct VectorOf {
  using Value = std::vector<T>;
  static constexpr auto type_name = py::detail::const_name("ArrayLike");
  static Value from(py::handle value, const char* argument) { return as_vector<T>(value, argument, kShape.text); }
};

template <class T>
struct Instance {
  using Value = T;
  static constexpr auto type_name = py::detail::make_caster<T>::name;
  static T from(py::handle value, const char* argument) {
    py::detail::make_caster<T> caster;
    if (!value.is_none() && caster.load(value, false)) return py::detail::cast_op<T>(caster);
    detail::refuse_instance(py::type::of<typename detail::BoundClass<T>::Type>(), argument, value);
  }
};

template <class Kind>
struct Optional {
  using Value = std::optional<typename Kind::Value>;
  static constexpr auto type_name = Kind::type_name + py::detail::const_name(" | None");
  static Value from(py::handle value, const char* argument) {
    return value.is_none() ? Value() : Value(Kind::from(value, argument));
  }
};

template <class Kind>
struct List {
  using Value = std::vector<typename Kind::Value>;
  static constexpr auto type_name = py::detail::const_name("Sequence[") + Kind::type_name + py::detail::const_name("]");
  static Value from(py::handle value, const char* argument) {
    Value values;
    for (const py::object& item : detail::checked_items(value, argument)) {
      const std::string place = std::string(argument) + "[" + std::to_string(values.size()) + "]";
      values.push_back(Kind::from(item, place.c_str()));
    }
    return values;
  }
};

}  // namespace echopath::bindings

namespace pybind11::detail {

template <echopath::bindings::Literal kName, class Kind>
struct type_caster<echopath::bindings::Arg<kName, Kind>> {
  using Argument = echopath::bindings::Arg<kName, Kind>;
  static constexpr auto name = Kind::type_name;
  template <class>
  using cast_op_type = Argument&&;

  // Raises what the caller is to read. pybind11's own way, to answer false, would end in a list of signatures.
  bool load(handle value, bool) {
    const echopath::bindings::InCall in_call;
    argument_ = Argument(Kind::from(value, Argument::name()));
    return true;
  }
  operator Argument&&() && { return std::move(argument_); }

 private:
  Argument argument_;
};

}  // namespace pybind11::detail
