#pragma once
// The posed triangles of a scene behind Embree; the only file pair that knows Embree and its versions.
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "echopath/base/job.h"
#include "echopath/scene/scene.h"
#include "echopath/trace/paths.h"

namespace echopath {

struct RayHit {
  Hit hit;
  Vec3 position;  // rebuilt in double from (u, v), relative to the origin; on the curved surface where it is smooth
  Vec3 normal;    // unit, flipped against the ray
  double distance = 0.0;  // m, along the ray
  bool is_smooth = false;
  double stretch = 1.0;
  Mat3 curvature;  // 1/m on the side of `normal`: positive where convex (scene/smooth.h); only where smooth
};

// Coordinates are relative to `origin` (world), so that single precision resolves what lies around it. A ray that starts far
// outside the scene is moved up to it in double precision first.
// Thread-safe for queries.
class EmbreeScene {
 public:
  // Raises DeviceError when Embree fails, Cancelled when the job is cancelled during the build.
  EmbreeScene(const Scene& scene, const Pose& pose, const Vec3& origin, Job* job = nullptr);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  enum class Verdict { kMiss, kHit, kFalseHit };
  // Closest hit from `from` along the unit vector `direction`. kFalseHit: Embree reported a point that double precision
  // does not find on the ray (slivers near grazing); treated as lost.
  Verdict intersect(const Vec3& from, const Vec3& direction, RayHit& out) const;
  // Something lies on the open segment between the two points. Points on surfaces are to be lifted first.
  bool occluded(const Vec3& from, const Vec3& to) const;
  // The point moved off its surface by a few units of single precision, so that it does not meet it again.
  Vec3 lifted(const Vec3& point, const Vec3& normal) const;

  // The point of the scene's bounding box next to `near` (world): the origin that serves rays from there best.
  static Vec3 origin_near(const Scene& scene, const Pose& pose, const Vec3& near);

  std::array<Vec3, 3> corners(uint32_t mesh_id, uint32_t triangle_id) const;
  const std::vector<Vec3>& vertices(uint32_t mesh_id) const { return vertices_[mesh_id]; }

 private:
  Vec3 moved_up(const Vec3& from, const Vec3& direction) const;

  struct Device;
  std::unique_ptr<Device> device_;
  const Scene* scene_;
  double reach_ = 0.0;  // m: radius around the origin that holds the scene
  void curve(const std::array<Vec3, 3>& corners, const Vec3& direction, RayHit& hit) const;

  std::vector<std::vector<Vec3>> vertices_;  // by mesh ID, relative to the origin
  std::vector<std::vector<Vec3>> normals_;   // by mesh ID, of vertices; empty where facets are meant
};

}  // namespace echopath
