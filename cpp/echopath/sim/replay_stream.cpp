#include "echopath/sim/replay_stream.h"

#include <algorithm>
#include <atomic>
#include <utility>

#include "echopath/base/parallel.h"
#include "echopath/signal/echo_states.h"
#include "echopath/signal/echoes.h"

namespace echopath {
namespace {

constexpr int64_t kBlocksInFlight = 16;        // fixed: results must not depend on the number of threads
constexpr int64_t kEchoesInFlight = 1 << 18;   // node values per channel set: paths x channels
constexpr int64_t kNodesOfAPath = 32;          // that these echoes may have each before there are fewer of them
constexpr int64_t kLargestBlock = 8192;

int64_t block_size(int64_t num_channels, int64_t num_nodes) {
  const int64_t values = num_channels * std::max<int64_t>(1, num_nodes / kNodesOfAPath);
  return std::clamp<int64_t>(kEchoesInFlight / (kBlocksInFlight * values), 1, kLargestBlock);
}

// Indices of the paths on which nothing moves, and of the others.
std::pair<std::vector<int64_t>, std::vector<int64_t>> split_by_motion(const Replayer& replayer, int64_t num_paths, Job* job) {
  std::pair<std::vector<int64_t>, std::vector<int64_t>> split;
  auto& [still, moving] = split;
  const auto is_still = [&](int64_t path) {
    if (job && path % kLargestBlock == 0) job->throw_if_cancelled();
    return replayer.is_static(path);
  };
  int64_t num_still = 0;
  for (int64_t path = 0; path < num_paths; ++path) num_still += is_still(path) ? 1 : 0;
  still.reserve(static_cast<size_t>(num_still));
  moving.reserve(static_cast<size_t>(num_paths - num_still));
  for (int64_t path = 0; path < num_paths; ++path) (is_still(path) ? still : moving).push_back(path);
  return split;
}

}  // namespace

void ReplayStream::run(const Sink& sink) const {
  const auto [still, moving] = split_by_motion(replayer_, num_paths_, job_);
  add_still(still, sink);
  add_moving(moving, sink);
}

void ReplayStream::add_still(const std::vector<int64_t>& paths, const Sink& sink) const {
  run_blocks(paths, block_size(num_channels(), 1), [&](auto part, auto&) { return replayer_.still(part); }, sink);
}

// Each path at the order that its meshes need; where that was not enough, at the next.
void ReplayStream::add_moving(const std::vector<int64_t>& paths, const Sink& sink) const {
  const int num_levels = replayer_.num_levels();
  std::vector<std::vector<int64_t>> by_level(static_cast<size_t>(num_levels) + 2);
  for (const int64_t path : paths) by_level[static_cast<size_t>(replayer_.first_level(path))].push_back(path);
  const int64_t size = block_size(num_channels(), kNodesOfAPath);
  for (int level = 1; level <= num_levels; ++level) {
    const auto at = static_cast<size_t>(level);
    const Replay replay = [&](auto part, std::vector<int64_t>& left) { return replayer_.interpolated(part, level, left); };
    const std::vector<int64_t> failed = run_blocks(by_level[at], size, replay, sink);
    by_level[at + 1].insert(by_level[at + 1].end(), failed.begin(), failed.end());
  }
  run_blocks(by_level.back(), block_size(num_channels(), replayer_.num_exact_nodes()),
             [&](auto part, auto&) { return replayer_.exact(part); }, sink);
}

// Blocks are replayed in parallel, a fixed number at a time, and handed over in their order. Returns the paths that `replay`
// left.
std::vector<int64_t> ReplayStream::run_blocks(const std::vector<int64_t>& paths, int64_t size, const Replay& replay,
                                              const Sink& sink) const {
  std::vector<int64_t> all_left;
  const auto num_paths = static_cast<int64_t>(paths.size());
  for (int64_t begin = 0; begin < num_paths; begin += size * kBlocksInFlight) {
    const int64_t num_blocks = std::min(kBlocksInFlight, (num_paths - begin + size - 1) / size);
    const auto part = [&](int64_t i) {
      const int64_t first = begin + i * size;
      return std::span<const int64_t>(paths.data() + first, static_cast<size_t>(std::min(size, num_paths - first)));
    };
    std::vector<std::vector<Echoes>> by_channel(static_cast<size_t>(num_channels()));
    for (std::vector<Echoes>& blocks : by_channel) blocks.resize(static_cast<size_t>(num_blocks));
    std::vector<std::vector<int64_t>> left(static_cast<size_t>(num_blocks));
    parallel_for(num_blocks, [&](int64_t i) {
      if (job_) job_->throw_if_cancelled();
      std::vector<Echoes> channels = replay(part(i), left[static_cast<size_t>(i)]);
      for (size_t channel = 0; channel < channels.size(); ++channel) by_channel[channel][static_cast<size_t>(i)] = std::move(channels[channel]);
    });
    const auto handed_over = static_cast<size_t>(std::min(size * num_blocks, num_paths - begin));
    for (size_t channel = 0; channel < by_channel.size(); ++channel) {
      if (job_) job_->throw_if_cancelled();
      sink(static_cast<int>(channel), by_channel[channel], {paths.data() + begin, handed_over});
    }
    for (const std::vector<int64_t>& some : left) all_left.insert(all_left.end(), some.begin(), some.end());
  }
  return all_left;
}

int64_t replay_only(const Paths& paths, const Radar& radar, const ReplaySettings& settings, Job* job) {
  const ReplayStream stream(paths, radar, settings, job);
  std::atomic<int64_t> path_chirps = 0;
  stream.run([&](int, std::span<Echoes> blocks, std::span<const int64_t>) {
    for (const Echoes& echoes : blocks) {
      parallel_for(echoes.sampling.is_static() ? 1 : radar.waveform.num_chirps, [&](int64_t chirp) {
        EchoStates states;
        for (int64_t begin = 0; begin < echoes.num_echoes; begin += EchoStates::kCapacity) {
          const auto count = static_cast<int>(std::min<int64_t>(EchoStates::kCapacity, echoes.num_echoes - begin));
          evaluate_states(echoes, static_cast<int>(chirp), begin, count, states);
        }
        path_chirps += echoes.num_echoes;
      });
    }
  });
  return path_chirps;
}

}  // namespace echopath
