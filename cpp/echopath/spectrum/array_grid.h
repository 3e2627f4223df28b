#pragma once
// Finds the grid of equal steps that a set of points lies on.
#include <optional>
#include <vector>

#include "echopath/spectrum/virtual_array.h"

namespace echopath {

struct GridFit {
  ArrayGrid grid;
  std::vector<int> row, column;  // [N] of each point
};

// points [N] m, all different; tolerance in m, min_spacing in m: smallest step.
// Returns none when the points are in no plane, or on no line or rectangle of equal steps in it.
std::optional<GridFit> fit_grid(const std::vector<Vec3>& points, double tolerance, double min_spacing);

}  // namespace echopath
