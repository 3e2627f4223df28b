#pragma once
// Cuts a triangle soup along its non-manifold edges and vertices.
#include <cstdint>
#include <vector>

#include "echopath/scene/mesh/mesh.h"

namespace echopath {

// Gives vertices of their own to sheets that meet in a non-manifold edge (more than two faces, or two that run through
// it in the same direction) or a non-manifold vertex (more than one fan of faces), so that the result is an oriented
// manifold with boundary. No face is lost, none changes its place or its order.
//
// triangles [F]: corners are renumbered in place. original_vertex [V]: origin of each vertex; copies are appended. All
// vertices must be used. Method: cutting (Gueziec, Taubin, Lazarus, Horn, "Converting sets of polygons to manifold
// surfaces by cutting", IEEE Visualization 1998).
void cut_to_manifold(std::vector<Triangle>& triangles, std::vector<uint32_t>& original_vertex);

}  // namespace echopath
