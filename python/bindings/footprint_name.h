#pragma once
// Names of the footprint filters in Python.
#include <array>
#include <stdexcept>
#include <string>

#include "echopath/em/footprint.h"

namespace echopath::bindings {

inline constexpr std::array<const char*, 3> kFootprints = {"none", "first_order", "second_order"};

inline Footprint as_footprint(const std::string& name) {
  for (size_t i = 0; i < kFootprints.size(); ++i) {
    if (name == kFootprints[i]) return static_cast<Footprint>(i);
  }
  throw std::invalid_argument("footprint: must be 'second_order', 'first_order' or 'none', got '" + name + "'");
}

}  // namespace echopath::bindings
