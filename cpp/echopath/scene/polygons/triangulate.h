#pragma once
// Cuts polygons into triangles. Internal to the module.
#include <cstdint>
#include <vector>

#include "echopath/scene/mesh/mesh.h"

namespace echopath {

// Cuts a simple polygon `corners` (indices into `vertices`, three or more) into triangles of the same direction: a fan where
// it is convex, else ear by ear (Meisters 1975), always the ear of the first corner that has one. What has no ears, such as
// the rest of a polygon that crosses itself, is cut into a fan. It takes about n log n steps for n corners. Returns n - 2
// triangles of indices into `corners`.
std::vector<Triangle> triangulate(const std::vector<Vec3>& vertices, const std::vector<uint32_t>& corners);

}  // namespace echopath
