#pragma once
// Finds how near objects are.
#include <map>
#include <mutex>
#include <span>
#include <vector>

#include "echopath/trace/geometry/embree_scene.h"

namespace echopath {

// Knows the longest edges of meshes as they are posed, by which most triangles need not be looked at.
class NearestPoints {
 public:
  // The scene, the pose and the geometry must outlive it; the geometry is the scene at the pose. Only `mesh_ids` are asked about.
  NearestPoints(const Scene& scene, const PosedScene& pose, const EmbreeScene& geometry, std::span<const uint32_t> mesh_ids);
  // Returns the distance in m from a point, relative to the geometry's origin, to the nearest point of the triangles of some
  // meshes.
  double distance(const Vec3& point, std::span<const uint32_t> mesh_ids) const;

 private:
  double distance_to_mesh(const Vec3& point, uint32_t mesh, double least) const;

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
