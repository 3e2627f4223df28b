#pragma once
// Tells which normals a file gives the corners of its triangles. Internal to the module.
#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "echopath/scene/readers/soup.h"

namespace echopath {

// Gives unit normals of corners: those of the file; within a smoothing group, where a face has none, the mean over the faces
// of the group at the vertex, weighted by area; the facet's own otherwise.
class CornerNormals {
 public:
  explicit CornerNormals(const Soup& soup);  // which must outlive this

  // Returns whether the file says anything of the normals of these triangles.
  bool are_given(const std::vector<uint32_t>& triangles) const;

  std::array<Vec3, 3> of(uint32_t triangle) const;

 private:
  bool has_own(uint32_t triangle) const;
  uint32_t smoothing(uint32_t triangle) const;
  static uint64_t key(uint32_t group, uint32_t vertex) { return static_cast<uint64_t>(group) << 32 | vertex; }

  const Soup& soup_;
  std::unordered_map<uint64_t, Vec3> sums_;  // of the vector areas of a smoothing group at a vertex
};

}  // namespace echopath
