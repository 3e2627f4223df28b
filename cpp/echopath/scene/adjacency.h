#pragma once
// Which triangles meet at the edges of a mesh.
#include <array>
#include <cstdint>
#include <vector>

#include "echopath/scene/mesh.h"

namespace echopath {

inline constexpr uint32_t kNoTriangle = 0xFFFFFFFFu;

// [F] the triangle across each edge, edge i leading from corner i to corner i + 1; kNoTriangle where none or more than one
// meets. Corners are one where they lie at the same place, so that seams of files that repeat their vertices do not count.
std::vector<std::array<uint32_t, 3>> edge_neighbours(const std::vector<Vec3>& vertices,
                                                     const std::vector<Triangle>& triangles);

}  // namespace echopath
