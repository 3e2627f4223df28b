#include "echopath/power/path_power.h"

#include <algorithm>
#include <complex>
#include <numeric>

#include "echopath/base/errors.h"
#include "echopath/replay/replay.h"

namespace echopath {
namespace {

constexpr int64_t kPathsPerBlock = 1 << 19;

}  // namespace

std::vector<double> path_power(const Paths& paths, Job* job) {
  if (paths.num_paths() == 0) return {};
  require(paths.scene != nullptr, "paths", "must carry a scene to know powers", "none");
  const Radar radar = one_channel(paths.radar);
  const Replayer replayer(paths, radar);
  std::vector<double> power, lengths;
  std::vector<std::complex<double>> amplitudes;
  power.reserve(static_cast<size_t>(paths.num_paths()));
  for (int64_t begin = 0; begin < paths.num_paths(); begin += kPathsPerBlock) {
    std::vector<int64_t> block(static_cast<size_t>(std::min(kPathsPerBlock, paths.num_paths() - begin)));
    std::iota(block.begin(), block.end(), begin);
    replayer.evaluate(block, paths.frame.trace_time, lengths, amplitudes, job);
    for (const std::complex<double>& amplitude : amplitudes) power.push_back(std::norm(amplitude));
  }
  return power;
}

}  // namespace echopath
