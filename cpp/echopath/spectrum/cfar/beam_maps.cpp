#include "echopath/spectrum/cfar/beam_maps.h"

#include <algorithm>

#include "echopath/base/threads/parallel.h"
#include "echopath/spectrum/array/covering_directions.h"

namespace echopath {
namespace {

constexpr int64_t kValuesTogether = 1 << 23;  // 64 MiB

}  // namespace

BeamMaps::BeamMaps(const RangeDoppler& map, const Radar& radar)
    : source_(map, radar, {}), directions_(covering_directions(source_.array())), num_velocities_(std::ssize(map.velocity)),
      num_ranges_(std::ssize(map.range)) {}

int64_t BeamMaps::num_together() const {
  return std::clamp(kValuesTogether / (num_velocities_ * num_ranges_), int64_t{1}, num_beams());
}

std::vector<std::vector<double>> BeamMaps::powers(int64_t first, int64_t count, Job* job) const {
  const BeamKernel beams(source_.array(), {directions_.begin() + first, directions_.begin() + first + count});
  std::vector<std::vector<double>> maps(count, std::vector<double>(num_velocities_ * num_ranges_));
  parallel_for(num_velocities_, [&](int64_t v) {
    for (int64_t begin = 0; begin < num_ranges_; begin += BeamKernel::kColumns) {
      const int64_t size = std::min(BeamKernel::kColumns, num_ranges_ - begin);
      BeamKernel::Powers power(count * BeamKernel::kColumns);
      beams.add_squares(source_.weighted(v, begin, size), Combine::kSum, power);
      for (int64_t beam = 0; beam < count; ++beam)
        std::copy_n(&power[beam * BeamKernel::kColumns], size, &maps[beam][v * num_ranges_ + begin]);
    }
  }, job);
  return maps;
}

}  // namespace echopath
