#pragma once
// Measures the planes of a mesh.
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "echopath/scene/mesh/mesh.h"

namespace echopath {

// Holds the planes of several triangles (planar_patches.h); every other triangle is a plane of its own.
struct PatchSizes {
  std::vector<uint32_t> triangles;  // plane by plane
  std::vector<uint32_t> ends;       // [P] of each plane in `triangles`
  std::vector<double> area, rim;    // [P] m^2, and m of the edges that lead out of it

  std::span<const uint32_t> of_plane(size_t plane) const {
    const uint32_t begin = plane == 0 ? 0 : ends[plane - 1];
    return {triangles.data() + begin, ends[plane] - begin};
  }
};

// Returns those of a mesh under the linear part of its place in the world. Those of large meshes, which take seconds for
// millions of triangles, are kept.
std::shared_ptr<const PatchSizes> patch_sizes(const MeshPtr& mesh, const Mat3& linear);

}  // namespace echopath
