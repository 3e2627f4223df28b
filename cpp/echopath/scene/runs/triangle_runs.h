#pragma once
// Bounds triangles that follow each other in a mesh by boxes: what is far away need not be looked at one by one.
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "echopath/base/geometry.h"

namespace echopath {

inline constexpr uint32_t kRunLength = 16;  // triangles; the last run may be shorter

// Returns the boxes of the runs of a mesh, in order, m.
std::vector<Box> find_boxes_of_runs(const std::vector<Vec3>& vertices,
                                    const std::vector<std::array<uint32_t, 3>>& triangles);

}  // namespace echopath
