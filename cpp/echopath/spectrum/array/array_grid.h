#pragma once
// Finds the grid of equal steps that a set of points lies on.
#include <optional>
#include <vector>

#include "echopath/spectrum/array/virtual_array.h"

namespace echopath {

struct GridFit {
  ArrayGrid grid;
  std::vector<int> row, column;  // [N] place of each point in the grid
};

// `points` [N] are in m and all different; `tolerance` is in m; `min_spacing` is the smallest step in m.
// Returns none when the points are in no plane, or on no line or rectangle of equal steps in it.
std::optional<GridFit> fit_grid(const std::vector<Vec3>& points, double tolerance, double min_spacing);

}  // namespace echopath
