#pragma once
// Finds how near objects are.
#include <array>
#include <map>
#include <mutex>
#include <span>
#include <vector>

#include "echopath/trace/geometry/embree_scene.h"

namespace echopath {

// Knows the longest edges of meshes as they are posed, by which most triangles need not be looked at.
class NearestPoints {
 public:
  // The scene, the pose and the geometry must outlive it; the geometry is the scene at the pose. Only `mesh_ids` are asked
  // about.
  NearestPoints(const Scene& scene, const PosedScene& pose, const EmbreeScene& geometry, std::span<const uint32_t> mesh_ids);
  // Returns the distances in m from two points, relative to the geometry's origin, to the nearest points of the triangles of
  // some meshes. Where the points are near each other they cost little more than one.
  using Points = std::array<Vec3, 2>;
  std::array<double, 2> distances(const Points& points, std::span<const uint32_t> mesh_ids) const;

 private:
  void look_at_mesh(const Points& points, uint32_t mesh, std::array<double, 2>& least) const;

  const Scene& scene_;
  const EmbreeScene& geometry_;
  // Of a mesh, m, in its own frame or, where it deforms, posed; found when it is first asked for.
  struct LongestEdge {
    std::once_flag is_found;
    double length = 0.0;
  };
  double longest_edge(uint32_t mesh_id) const;

  const PosedScene& pose_;
  mutable std::map<const Mesh*, LongestEdge> of_meshes_;  // that several nodes may share
  mutable std::map<uint32_t, LongestEdge> of_deformed_;   // by mesh ID
};

}  // namespace echopath
