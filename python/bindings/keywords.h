#pragma once
// Keywords of the constructors: what C++ knows by name is refused by name.
#include <pybind11/pybind11.h>

#include <string>
#include <string_view>
#include <vector>

#include "echopath/base/errors.h"

namespace echopath::bindings {

// Raises TypeError naming the nearest right one when `unknown`, the **kwargs of a call, is not empty.
inline void refuse_unknown(const pybind11::kwargs& unknown, std::string_view callee, const std::vector<std::string>& known) {
  if (unknown.empty()) return;
  const auto word = pybind11::cast<std::string>(pybind11::handle((*unknown.begin()).first));
  throw pybind11::type_error(std::string(callee) + ": unknown keyword '" + word + "', the nearest right one is '" +
                             nearest_names(word, known, 1).front() + "'");
}

}  // namespace echopath::bindings
