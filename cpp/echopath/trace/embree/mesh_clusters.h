#pragma once
// Sorts out which small meshes share a tree.
#include <cstdint>
#include <vector>

#include "echopath/base/geometry.h"

namespace echopath {

// Describes a mesh at rest that has few triangles.
struct SmallMesh {
  static constexpr size_t kMostTriangles = 256;
  uint32_t mesh_id;
  uint32_t num_triangles;
  Box box;  // m, world
};

// Returns clusters of neighbours, each a list of mesh IDs, ascending: the meshes in a cell of an octree over the world,
// which is divided down to 2000 triangles a cell. Meshes that would be among fewer than eight, or longer than a quarter of
// their cluster, belong to none; neither does any where there are fewer than 256. The clusters follow from the boxes alone,
// and what moves changes those about it and no others. Cost: 100 ns a mesh.
std::vector<std::vector<uint32_t>> clusters_of(const std::vector<SmallMesh>& meshes);

}  // namespace echopath
