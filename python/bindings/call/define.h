#pragma once
// Binds functions and constructors whose arguments are of argument.h, so that every call that does not fit is refused by
// name: an unknown keyword (with the nearest right one), a missing argument, one given twice, too many. When Python ends,
// calls of them are waited for (leaving.h).
#include <pybind11/pybind11.h>

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "call/argument.h"
#include "call/leaving.h"

namespace echopath::bindings {

namespace detail {

struct Parameter {
  std::string name;
  bool is_required;
  bool is_keyword_only;
  std::string default_text;  // as Python writes it
};

// Gathers the parameters among what is handed to `def`.
class Parameters {
 public:
  template <class... Extra>
  explicit Parameters(const Extra&... extra) {
    (add(extra), ...);
  }
  const std::vector<Parameter>& list() const { return list_; }

 private:
  void add(const py::arg& one) { list_.push_back({one.name, true, keyword_only_, ""}); }
  void add(const py::arg_v& one) {
    list_.push_back({one.name, false, keyword_only_, py::cast<std::string>(py::repr(one.value))});
  }
  void add(const py::kw_only&) { keyword_only_ = true; }
  template <class Other>
  void add(const Other&) {}

  std::vector<Parameter> list_;
  bool keyword_only_ = false;
};

// The names of the arguments of a class's constructor, in their order; filled by define_init.
template <class Class>
std::vector<std::string>& argument_names() {
  static std::vector<std::string> names;
  return names;
}

template <class T>
struct IsArg : std::is_base_of<py::object, T> {};
template <Literal kName, class Kind>
struct IsArg<Arg<kName, Kind>> : std::true_type {};

// Whether all arguments behind the first `skipped` ones are of argument.h, or any object. Others would answer wrong values
// with a list of signatures, and would be refused where pybind11 tries a call without conversions first.
template <size_t skipped, class Return, class... Arguments>
consteval bool all_checked(Return (*)(Arguments...)) {
  size_t place = 0;
  return ((place++ < skipped || IsArg<std::decay_t<Arguments>>::value) && ...);
}

// Whether it takes any keywords, `py::kwargs`.
template <class Return, class... Arguments>
consteval bool takes_keywords(Return (*)(Arguments...)) {
  return (std::is_same_v<std::decay_t<Arguments>, py::kwargs> || ...);
}

enum class Bound { kFunction, kMethod, kStatic };

struct Callee {
  py::handle scope;
  const char* name;
  Bound bound;
  bool takes_keywords = false;  // any
};

// Binds what a callee answers where the arguments do not fit, an error, and writes its signature down, so that
// inspect.signature, help() and editors show its parameters.
void define_refusal(const Callee& callee, const Parameters& parameters);

// Replaces the docstring of a function or method that pybind11 bound.
void write_doc(py::handle scope, const char* name, const std::string& doc);

}  // namespace detail

// scope: a module, or a class, whose function then takes the object first; extra: py::arg, py::kw_only and the docstring
template <class Scope, class Function, class... Extra>
Scope& define(Scope& scope, const char* name, Function&& function, const Extra&... extra) {
  constexpr bool is_method = !std::is_same_v<Scope, py::module_>;
  using Signature = py::detail::function_signature_t<Function>;
  static_assert(detail::all_checked<is_method ? 1 : 0>(static_cast<Signature*>(nullptr)), "arguments must be Arg<...>");
  scope.def(name, std::forward<Function>(function), py::call_guard<InCall>(), extra...);
  constexpr bool takes_keywords = detail::takes_keywords(static_cast<Signature*>(nullptr));
  detail::define_refusal({scope, name, is_method ? detail::Bound::kMethod : detail::Bound::kFunction, takes_keywords},
                         detail::Parameters(extra...));
  return scope;
}

template <class Class, class Function, class... Extra>
Class& define_static(Class& type, const char* name, Function&& function, const Extra&... extra) {
  using Signature = py::detail::function_signature_t<Function>;
  static_assert(detail::all_checked<0>(static_cast<Signature*>(nullptr)), "arguments must be Arg<...>");
  type.def_static(name, std::forward<Function>(function), py::call_guard<InCall>(), extra...);
  detail::define_refusal({type, name, detail::Bound::kStatic}, detail::Parameters(extra...));
  return type;
}

// make: a function that returns the new object
template <class Class, class Make, class... Extra>
Class& define_init(Class& type, Make make, const Extra&... extra) {
  using Signature = py::detail::function_signature_t<Make>;
  static_assert(detail::all_checked<0>(static_cast<Signature*>(nullptr)), "arguments must be Arg<...>");
  type.def(py::init(make), py::call_guard<InCall>(), extra...);
  const detail::Parameters parameters(extra...);
  detail::define_refusal({type, "__init__", detail::Bound::kMethod}, parameters);
  for (const detail::Parameter& each : parameters.list())
    detail::argument_names<typename Class::type>().push_back(each.name);
  return type;
}

// Of a class whose objects no caller makes; `makers` are the functions that return them, as an error names them.
template <class Class>
Class& define_no_init(Class& type, const char* makers) {
  const std::string text = std::string("is made by ") + makers;
  type.def(
      "__init__",
      [type_name = py::cast<std::string>(type.attr("__name__")), text](py::detail::value_and_holder&, const py::args&,
                                                                       const py::kwargs&) {
        throw py::type_error(type_name + ": " + text);
      },
      py::detail::is_new_style_constructor());
  detail::write_doc(type, "__init__", "__init__(self)\n--\n\nRaises TypeError: " + text + ".");
  return type;
}

}  // namespace echopath::bindings
