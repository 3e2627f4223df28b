#pragma once
// How antennas and radars show where they are.
#include <pybind11/pybind11.h>

#include <sstream>
#include <string>

#include "echopath/base/geometry.h"

namespace echopath::bindings {

namespace py = pybind11;

inline py::tuple tuple_of(const Vec3& vector) { return py::make_tuple(vector.x(), vector.y(), vector.z()); }

template <class Part>
std::string part_text(const Part& part) {
  return py::cast<std::string>(py::repr(py::cast(part)));
}

// position in m; yaw and pitch in rad
inline std::string place_text(const Vec3& position, double yaw, double pitch) {
  std::ostringstream text;
  text << "(" << position.x() << ", " << position.y() << ", " << position.z() << ") m";
  if (yaw != 0.0 || pitch != 0.0) text << ", yaw " << yaw << " rad, pitch " << pitch << " rad";
  return text.str();
}

}  // namespace echopath::bindings
