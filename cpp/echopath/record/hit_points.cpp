#include "echopath/record/hit_points.h"

#include "echopath/base/threads/parallel.h"

namespace echopath {
namespace {

constexpr int64_t kHitsPerTask = 1 << 19;

}  // namespace

std::vector<double> hit_points(const Paths& paths, double time, Job* job) {
  const PosedScene pose(*paths.scene, time);
  std::vector<double> out(3 * static_cast<size_t>(paths.num_hits()));
  parallel_for_chunks(paths.num_hits(), kHitsPerTask, [&](int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; ++i) Eigen::Map<Vec3>(out.data() + 3 * i) = hit_point(pose, (*paths.hits)[i]);
  }, job);
  return out;
}

}  // namespace echopath
