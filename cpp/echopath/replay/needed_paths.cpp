// The part of the replayer that tells which paths and meshes are needed.
#include <algorithm>
#include <cmath>
#include <limits>

#include "echopath/replay/replay.h"
#include "echopath/replay/time/node_tails.h"

namespace echopath {
namespace {

// The strongest path is looked for among so many, evenly spaced: a weaker one in its place leaves out fewer paths.
constexpr int64_t kStrongestAmong = 1 << 14;

}  // namespace

std::vector<uint32_t> Replayer::meshes_of(std::span<const int64_t> paths) const {
  std::vector<uint8_t> is_touched(paths_.scene->meshes().size());
  for (const int64_t path : paths) {
    const Hit* const hits = paths_.hits_of(path);
    for (int k = 0; k < paths_.num_bounces[static_cast<size_t>(path)]; ++k) is_touched[hits[k].mesh_id] = 1;
    if (paths_.passes.empty()) continue;
    for (const Pass& pass : paths_.passes_of(static_cast<size_t>(path))) is_touched[pass.hit.mesh_id] = 1;
  }
  std::vector<uint32_t> meshes;
  for (uint32_t mesh = 0; mesh < is_touched.size(); ++mesh) {
    if (is_touched[mesh]) meshes.push_back(mesh);
  }
  return meshes;
}

void Replayer::pose_polynomial(int polynomial, std::span<const int64_t> paths) {
  if (!posed_.is_whole(polynomial)) posed_.pose_polynomial(polynomial, meshes_of(paths));
}

void Replayer::find_strongest() {
  if (strongest_ > 0.0) return;
  std::vector<int64_t> some;
  const int64_t step = std::max<int64_t>(1, paths_.num_paths() / kStrongestAmong);
  for (int64_t path = 0; path < paths_.num_paths(); path += step) some.push_back(path);
  std::vector<double> lengths;
  std::vector<std::complex<double>> amplitudes;
  evaluate(some, paths_.frame.trace_time, lengths, amplitudes);
  for (size_t i = 0; i < some.size(); ++i) strongest_ = std::max(strongest_, std::abs(amplitudes[i]));
}

// Returns [P], 1 for paths that are negligible in all channels.
std::vector<uint8_t> Replayer::negligible_ones(const FrameNodes& nodes, std::span<const Echoes> channels) const {
  std::vector<uint8_t> is_negligible(static_cast<size_t>(channels.front().num_echoes), 1);
  const double rounding = std::numeric_limits<double>::epsilon() * strongest_;
  const double limit = rounding / static_cast<double>(std::max<int64_t>(1, paths_.num_paths()));
  for (const Echoes& channel : channels) {
    for (size_t p = 0; p < is_negligible.size(); ++p)
      is_negligible[p] = is_negligible[p] && is_dark(nodes, channel, p, limit);
  }
  return is_negligible;
}

}  // namespace echopath
