#pragma once
// Walks from a triangle over its neighbours to where a point lies over the surface.
#include <memory>
#include <optional>
#include <vector>

#include "echopath/base/memory/lazy.h"
#include "echopath/record/paths.h"
#include "echopath/replay/posed/local_paths.h"
#include "echopath/scene/mesh/adjacency.h"

namespace echopath {

class SurfaceWalk {
 public:
  // Both must outlive it.
  SurfaceWalk(const Scene& scene, const NormalsOfMeshes& smooth_normals);
  ~SurfaceWalk();

  struct Spot {
    Hit hit;
    bool is_near = true;  // in the triangle itself, in one that has a corner of it, or in its plane
  };
  // Finds where `point` lies over the mesh as its `vertices` stand (mesh frame), going from `triangle` over edges on which
  // the surface goes on: in one plane, or smoothly. Returns none where it ends before, at a rim or a crease. Thread-safe.
  std::optional<Spot> find(uint32_t mesh_id, uint32_t triangle, const std::vector<Vec3>& vertices, const Vec3& point) const;

 private:
  struct Surface;
  const Surface& surface(uint32_t mesh_id) const;

  const Scene& scene_;
  const NormalsOfMeshes& smooth_normals_;
  std::vector<Lazy<std::unique_ptr<const Surface>>> surfaces_;  // by mesh ID
};

}  // namespace echopath
