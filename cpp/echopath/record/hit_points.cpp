#include "echopath/record/hit_points.h"

#include <algorithm>

#include "echopath/base/threads/parallel.h"

namespace echopath {
namespace {

constexpr int64_t kHitsPerTask = 1 << 19;

}  // namespace

std::vector<double> hit_points(const Paths& paths, double time, Job* job) {
  const PosedScene pose(*paths.scene, time);
  std::vector<double> out(3 * static_cast<size_t>(paths.num_hits()));
  parallel_for((paths.num_hits() + kHitsPerTask - 1) / kHitsPerTask, [&](int64_t block) {
    const int64_t end = std::min((block + 1) * kHitsPerTask, paths.num_hits());
    for (int64_t i = block * kHitsPerTask; i < end; ++i) {
      Eigen::Map<Vec3>(out.data() + 3 * i) = hit_point(pose, (*paths.hits)[i]);
    }
  }, job);
  return out;
}

}  // namespace echopath
