#pragma once
// Traces rays and segments one by one, as the tracer sees them, to compare them with the results of other ray tracers.
#include <cstdint>
#include <limits>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/scene/scene.h"

namespace echopath {

// Holds what rays meet first, [N] each.
struct RayAnswers {
  static constexpr uint32_t kNoMesh = std::numeric_limits<uint32_t>::max();
  std::vector<uint32_t> mesh_id, triangle_id;  // kNoMesh: nothing
  std::vector<double> distance;                // m
  std::vector<uint8_t> is_false;               // 1: found, but not confirmed in double precision
};

// Traces rays: origins [N] in m, world; directions [N] of any length; time in s. Raises invalid_argument unless there are as
// many of both; raises Cancelled.
RayAnswers first_hits(const Scene& scene, double time, const std::vector<Vec3>& origins, const std::vector<Vec3>& directions,
                      Job* job);

// Returns 1 where something lies on the open segment between starts and ends [N] in m, world. Raises as first_hits does.
std::vector<uint8_t> blocked_segments(const Scene& scene, double time, const std::vector<Vec3>& starts,
                                      const std::vector<Vec3>& ends, Job* job);

}  // namespace echopath
