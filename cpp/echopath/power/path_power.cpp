#include "echopath/power/path_power.h"

#include <algorithm>
#include <complex>

#include "echopath/base/errors.h"
#include "echopath/replay/replay.h"

namespace echopath {
namespace {

constexpr int64_t kPathsPerBlock = 1 << 19;

// Returns the powers of `count` paths in one channel, of which path i has the index index_of(i).
template <class IndexOf>
std::vector<double> powers_in_channel(const Paths& paths, int64_t count, const IndexOf& index_of, const Radar& channel,
                                      Job* job) {
  const Replayer replayer(paths, channel);
  std::vector<double> power, lengths;
  std::vector<std::complex<double>> amplitudes;
  power.reserve(count);
  for (int64_t begin = 0; begin < count; begin += kPathsPerBlock) {
    std::vector<int64_t> block(std::min(kPathsPerBlock, count - begin));
    for (size_t i = 0; i < block.size(); ++i) block[i] = index_of(begin + static_cast<int64_t>(i));
    replayer.evaluate(block, paths.frame.trace_time, lengths, amplitudes, job);
    for (const std::complex<double>& amplitude : amplitudes) power.push_back(std::norm(amplitude));
  }
  return power;
}

}  // namespace

std::vector<double> path_power(const Paths& paths, Job* job) {
  if (paths.num_paths() == 0) return {};
  require(paths.scene != nullptr, "paths", "must carry a scene to know powers", "none");
  return powers_in_channel(paths, paths.num_paths(), [](int64_t i) { return i; }, one_channel(paths.radar), job);
}

std::vector<double> path_power(const Paths& paths, std::span<const int64_t> some, const Radar& channel, Job* job) {
  return powers_in_channel(paths, std::ssize(some), [&](int64_t i) { return some[i]; }, channel, job);
}

}  // namespace echopath
