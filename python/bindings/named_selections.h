#pragma once
// Selections by name, as Python hands them over.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <string>
#include <utility>
#include <vector>

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

// {name: selection}
inline std::vector<NamedSelection> named_selections(const pybind11::dict& parts) {
  return named_selections(pybind11::list(parts.attr("items")()).cast<SelectionPairs>());
}

}  // namespace echopath::bindings
