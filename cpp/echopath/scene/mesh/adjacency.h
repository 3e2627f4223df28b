#pragma once
// Finds the triangles that share an edge of a mesh.
#include <array>
#include <cstdint>
#include <vector>

#include "echopath/scene/mesh/mesh.h"

namespace echopath {

inline constexpr uint32_t kNoTriangle = 0xFFFFFFFFu;

// Returns for each triangle [F] the triangle across each of its edges, edge i leading from corner i to corner i + 1;
// kNoTriangle where none or more than one meets it. Corners at the same place are one, so that files that repeat vertices at
// seams do not separate triangles.
std::vector<std::array<uint32_t, 3>> edge_neighbours(const std::vector<Vec3>& vertices,
                                                     const std::vector<Triangle>& triangles);

}  // namespace echopath
