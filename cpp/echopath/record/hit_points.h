#pragma once
// Tells where the hits of a record are at any time: each goes with its triangle.
#include <array>
#include <vector>

#include "echopath/posed/posed_scene.h"
#include "echopath/record/paths.h"

namespace echopath {

class Job;

// Returns the point of a hit on the corners of its triangle, m.
inline Vec3 hit_point(const std::array<Vec3, 3>& corners, const Hit& hit) {
  const auto& [a, b, c] = corners;
  return a + double{hit.u} * (b - a) + double{hit.v} * (c - a);
}
// Returns the point of a hit in the world, m, where the scene is posed so.
inline Vec3 hit_point(const PosedScene& pose, const Hit& hit) {
  return hit_point(pose.world_triangle(hit.mesh_id, hit.triangle_id), hit);
}

// Returns the points [H, 3] of all hits in the world at a time in s, in m. Raises Cancelled when the job is cancelled.
std::vector<double> hit_points(const Paths& paths, double time, Job* job);

}  // namespace echopath
