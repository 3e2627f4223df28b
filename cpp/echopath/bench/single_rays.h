#pragma once
// Rays and segments one by one, as the tracer sees them, to be compared with what other ray tracers find.
#include <cstdint>
#include <limits>
#include <vector>

#include "echopath/base/job.h"
#include "echopath/scene/scene.h"

namespace echopath {

// What rays meet first, [N] each.
struct RayAnswers {
  static constexpr uint32_t kNoMesh = std::numeric_limits<uint32_t>::max();
  std::vector<uint32_t> mesh_id, triangle_id;  // kNoMesh: nothing
  std::vector<double> distance;                // m
  std::vector<uint8_t> is_false;               // 1: found, but not confirmed in double precision
};

// origins [N] in m, world; directions [N] of any length; time in s. Raises invalid_argument unless there are as many of both, and
// Cancelled.
RayAnswers first_hits(const Scene& scene, double time, const std::vector<Vec3>& origins, const std::vector<Vec3>& directions,
                      Job* job = nullptr);

// Whether something lies on the open segments between starts and ends [N] in m, world: 1 where it does. Raises likewise.
std::vector<uint8_t> blocked_segments(const Scene& scene, double time, const std::vector<Vec3>& starts,
                                      const std::vector<Vec3>& ends, Job* job = nullptr);

}  // namespace echopath
