#pragma once
// Values: objects that are nothing but what their constructor was given, and have it as attributes of the same names.
#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <type_traits>
#include <utility>

#include "call/define.h"
#include "call/shown.h"

namespace echopath::bindings {

namespace detail {

// The attributes of an object that have one of the names.
pybind11::dict attributes_of(const pybind11::object& self, const std::vector<std::string>& names);
// Whether two keywords have equal values, arrays by their numbers.
bool same_values(const pybind11::dict& one, const pybind11::dict& other);
// Equal for equal values.
pybind11::ssize_t hash_of_values(const pybind11::dict& keywords);
// What `make` returns for keywords with changes.
pybind11::object remade(const pybind11::object& make, const pybind11::dict& keywords, const pybind11::dict& changes);
// The state of a pickle: the keywords, and beside them what an object of a class derived in Python has of its own.
pybind11::object state_of(const pybind11::object& self, const pybind11::dict& keywords);
// The keywords in the state of a pickle, and what is the object's own. Raises TypeError where it is none.
std::pair<pybind11::dict, pybind11::dict> checked_state(const pybind11::object& state, const char* type_name);

// Sets an attribute as Python does, or raises AttributeError with a hint at `replace`.
void refuse_change(pybind11::handle self, pybind11::handle name, pybind11::handle value);

// How pybind11 hands over new objects of a class.
template <class Value, class Holder>
using Held = std::conditional_t<std::is_same_v<Holder, std::shared_ptr<Value>>, std::shared_ptr<Value>, Value>;

// The Python callable that makes a Value of keywords: its class.
template <class Value>
pybind11::object constructor_for(const pybind11::dict&) {
  return pybind11::type::of<Value>();
}

}  // namespace detail

// Returns the keywords that make a value again: those attributes that have the name of an argument of its constructor.
template <class Value>
pybind11::dict keywords_by_attribute(const pybind11::object& self) {
  return detail::attributes_of(self, detail::argument_names<Value>());
}

using KeywordsOf = pybind11::dict (*)(const pybind11::object& self);
using MakerFor = pybind11::object (*)(const pybind11::dict& keywords);

// Gives a class pickle, copy, deepcopy, == and a hash. The state of a pickle is the keywords that make the value again, so
// it is checked by the constructor, as any other input, and what an object of a derived class has of its own. `maker_for`
// names what takes the keywords where that is not the class.
template <class Value, class... Options>
void define_value(pybind11::class_<Value, Options...>& type, KeywordsOf keywords_of = &keywords_by_attribute<Value>,
                  MakerFor maker_for = &detail::constructor_for<Value>) {
  namespace py = pybind11;
  using Held = detail::Held<Value, typename py::class_<Value, Options...>::holder_type>;
  type.def(
      "__eq__",
      [keywords_of](const py::object& self, const py::object& other) -> py::object {
        if (!py::isinstance<Value>(other)) return py::reinterpret_borrow<py::object>(Py_NotImplemented);
        return py::bool_(detail::same_values(keywords_of(self), keywords_of(other)));
      },
      py::arg("other"), "Whether the other one is made of the same values.");
  type.def("__hash__", [keywords_of](const py::object& self) { return detail::hash_of_values(keywords_of(self)); });
  type.def(py::pickle([keywords_of](const py::object& self) { return detail::state_of(self, keywords_of(self)); },
                      [maker_for](const py::object& state) {
                        const std::string name = py::cast<std::string>(py::type::of<Value>().attr("__name__"));
                        const auto [keywords, own] = detail::checked_state(state, name.c_str());
                        return std::pair(detail::remade(maker_for(keywords), keywords, py::dict()).template cast<Held>(),
                                         own);
                      }));
}

// Answers `value.name = ...` by what to write instead: attributes of a value are set by nobody. Classes derived in Python
// keep what they have of their own.
template <class Value, class... Options>
void define_no_change(pybind11::class_<Value, Options...>& type) {
  type.def("__setattr__", [](const pybind11::object& self, const pybind11::str& name, const pybind11::object& value) {
    detail::refuse_change(self, name, value);
  });
}

// Gives a value `replace`: a copy with other values of some of its keywords.
template <class Value, class... Options>
void define_replace(pybind11::class_<Value, Options...>& type, KeywordsOf keywords_of = &keywords_by_attribute<Value>,
                    MakerFor maker_for = &detail::constructor_for<Value>) {
  namespace py = pybind11;
  using Held = detail::Held<Value, typename py::class_<Value, Options...>::holder_type>;
  define(
      type, "replace",
      [keywords_of, maker_for](const py::object& self, const py::kwargs& changes) {
        const py::dict keywords = keywords_of(self);
        return detail::remade(maker_for(keywords), keywords, changes).template cast<Held>();
      },
      "A copy with other values of some arguments.\n\n"
      "changes: arguments of the constructor, by name\n"
      "Raises TypeError or ValueError as the constructor does.");
  define_no_change(type);
}

}  // namespace echopath::bindings
