#pragma once
// Finds how near objects are.
#include <array>
#include <map>
#include <span>

#include "echopath/base/memory/lazy.h"
#include "echopath/trace/embree/embree_scene.h"

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
  double longest_edge(uint32_t mesh_id) const;

  const PosedScene& pose_;
  // The lengths of the longest edges in m: of meshes, which several nodes may share, in their own frames, and by mesh ID of
  // those that deform, as posed.
  std::map<const Mesh*, Lazy<double>> of_meshes_;
  std::map<uint32_t, Lazy<double>> of_deformed_;
};

}  // namespace echopath
