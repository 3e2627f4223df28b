#pragma once
// Finds the box of points along the axes along which they spread.
#include <vector>

#include "echopath/base/geometry.h"

namespace echopath {

// Holds that box in coordinates of its own, which begin at the mean of the points.
struct PrincipalBox {
  Vec3 mean;
  Mat3 axes;  // unit columns; the points spread least along the first
  Box box;    // m

  Vec3 coordinates(const Vec3& point) const { return axes.transpose() * (point - mean); }
};

PrincipalBox principal_box(const std::vector<Vec3>& points);

}  // namespace echopath
