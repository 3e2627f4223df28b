#pragma once
// Groupings with what Python calls their parts.
#include <pybind11/pybind11.h>

#include <functional>
#include <string>

#include "echopath/label/grouping.h"

namespace echopath::bindings {

struct KeyedGrouping {
  Grouping rule;
  // The key of a part by its name. Needs the GIL; asked after the rule has sorted all records.
  std::function<pybind11::object(const std::string& name)> key_of;
  // What makes it again: (kind, arguments), the state of a pickle. Needs the GIL.
  std::function<pybind11::tuple()> recipe;
};

}  // namespace echopath::bindings
