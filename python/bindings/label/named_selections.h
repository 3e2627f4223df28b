#pragma once
// Selections as Python hands them over, alone and by name.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "call/argument.h"
#include "echopath/label/expressions/selection.h"
#include "echopath/label/partition.h"

namespace echopath::bindings {

// [(name, selection), ...]; a selection may be text.
using SelectionPairs = std::vector<std::pair<std::string, Selection>>;

inline std::vector<NamedSelection> named_selections(const SelectionPairs& pairs) {
  std::vector<NamedSelection> named;
  for (const auto& [name, selection] : pairs) named.push_back({name, selection});
  return named;
}

// A Selection, or its text.
struct SelectionOrText {
  using Value = Selection;
  static constexpr auto type_name = py::detail::make_caster<Selection>::name + py::detail::const_name(" | str");
  static Selection from(py::handle value, const char* argument) {
    if (py::isinstance<Selection>(value)) return value.cast<Selection>();
    if (!PyUnicode_Check(value.ptr())) refuse_type(argument, "must be a Selection or its text", value);
    const std::string text = detail::checked_text(value, argument);
    try {
      return Selection(text);
    } catch (const std::invalid_argument& fault) {
      // The text of a Selection itself is shown by the fault: whoever makes one of a key of a file names that.
      if (std::string_view(argument) == "text") throw;
      throw std::invalid_argument(std::string(argument) + ": " + fault.what());
    }
  }
};

// {name: selection}
struct SelectionsByName {
  using Value = std::vector<NamedSelection>;
  static constexpr auto type_name =
      py::detail::const_name("dict[str, ") + SelectionOrText::type_name + py::detail::const_name("]");
  static Value from(py::handle value, const char* argument) {
    if (!PyDict_Check(value.ptr())) refuse_type(argument, "must be a dict {name: selection}", value);
    Value named;
    for (const auto& [name, selection] : py::reinterpret_borrow<py::dict>(value)) {
      const std::string place = std::string(argument) + "[" + shown(name) + "]";
      named.push_back({detail::checked_text(name, argument), SelectionOrText::from(selection, place.c_str())});
    }
    return named;
  }
};

}  // namespace echopath::bindings
