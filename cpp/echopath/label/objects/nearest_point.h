#pragma once
// Finds how near objects are.
#include <array>
#include <span>

#include "echopath/trace/embree/embree_scene.h"

namespace echopath {

// Finds the nearest point of objects, mesh by mesh, the one with the nearest box first (scene/runs/nearest_of_runs.h).
class NearestPoints {
 public:
  // The scene, the pose and the geometry must outlive it; the geometry is the scene at the pose.
  NearestPoints(const Scene& scene, const PosedScene& pose, const EmbreeScene& geometry);
  // Returns the distances in m from two points, relative to the geometry's origin, to the nearest points of the triangles of
  // some meshes. Where the points are near each other they cost little more than one.
  using Points = std::array<Vec3, 2>;
  std::array<double, 2> distances(const Points& points, std::span<const uint32_t> mesh_ids) const;

 private:
  const Scene& scene_;
  const EmbreeScene& geometry_;
  const PosedScene& pose_;
};

}  // namespace echopath
