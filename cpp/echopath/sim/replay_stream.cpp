#include "echopath/sim/replay_stream.h"

#include <algorithm>
#include <utility>

#include "echopath/base/constants.h"
#include "echopath/base/errors.h"
#include "echopath/base/large_array.h"
#include "echopath/base/parallel.h"
#include "echopath/signal/echo_states.h"
#include "echopath/signal/echoes.h"

namespace echopath {
namespace {

constexpr int64_t kBlocksInFlight = ReplayStream::kBlocksInFlight;
constexpr int64_t kEchoesInFlight = 1 << 17;   // paths x channels; as many are handed over meanwhile
constexpr int64_t kNodesOfAPath = 32;          // with more nodes per path, fewer echoes are in flight
// The values of a block at its nodes stay in the second-level cache. No power of two: rows of nodes would share the sets of
// the first.
constexpr int64_t kLargestBlock = 1000;

// Echoes with nodes in every chirp are replayed few at a time, and the next take over their memory: a page that is touched
// for the first time costs as much as a path does at all its nodes.
constexpr int64_t kNodesOfChirps = 128;
constexpr int64_t kValuesInFlight = 150000;  // no power of two, as above
constexpr int64_t kLeastBlock = 64;  // fills the registers with vectors of joined echoes

int64_t block_size(int64_t num_channels, int64_t num_nodes) {
  const int64_t values = num_channels * std::max<int64_t>(1, num_nodes / kNodesOfAPath);
  const int64_t most = std::clamp<int64_t>(kEchoesInFlight / (kBlocksInFlight * values), 1, kLargestBlock);
  if (num_nodes <= kNodesOfChirps) return most;
  return std::min(most, std::max(kLeastBlock, kValuesInFlight / (kBlocksInFlight * num_channels * num_nodes)));
}

constexpr int64_t kPathsOfTask = 1 << 13;  // paths whose grids one task finds

// Sorts the indices of the paths by the grid that they begin with (PathGrids), in their order.
class PathsByGrid {
 public:
  PathsByGrid(const PathGrids& grids, int64_t num_paths, Job* job)
      : num_grids_(static_cast<size_t>(grids.num_grids())), grid_(static_cast<size_t>(num_paths)) {
    const int64_t num_tasks = (num_paths + kPathsOfTask - 1) / kPathsOfTask;
    place_.assign(static_cast<size_t>(num_tasks), std::vector<size_t>(num_grids_));
    parallel_for(num_tasks, [&](int64_t task) {
      if (job) job->throw_if_cancelled();
      find_grids(grids, task);
    });
    std::vector<std::vector<int64_t>> lists = lists_of_counts();
    parallel_for(num_tasks, [&](int64_t task) { fill(task, lists); });
    lists_ = std::move(lists);
  }

  std::vector<std::vector<int64_t>> take() { return std::move(lists_); }

 private:
  std::pair<int64_t, int64_t> range_of(int64_t task) const {
    return {task * kPathsOfTask, std::min<int64_t>((task + 1) * kPathsOfTask, static_cast<int64_t>(grid_.size()))};
  }

  void find_grids(const PathGrids& grids, int64_t task) {
    const auto [begin, end] = range_of(task);
    const std::span<uint8_t> here(grid_.data() + begin, static_cast<size_t>(end - begin));
    grids.first(begin, here);
    for (const uint8_t grid : here) ++place_[static_cast<size_t>(task)][grid];
  }

  // Turns the counts of the tasks into the places where each begins to write.
  std::vector<std::vector<int64_t>> lists_of_counts() {
    std::vector<size_t> sizes(num_grids_);
    for (std::vector<size_t>& places : place_) {
      for (size_t grid = 0; grid < num_grids_; ++grid) sizes[grid] += std::exchange(places[grid], sizes[grid]);
    }
    std::vector<std::vector<int64_t>> lists(num_grids_);
    for (size_t grid = 0; grid < num_grids_; ++grid) resize_large(lists[grid], sizes[grid]);
    return lists;
  }

  void fill(int64_t task, std::vector<std::vector<int64_t>>& lists) {
    const auto [begin, end] = range_of(task);
    std::vector<size_t>& places = place_[static_cast<size_t>(task)];
    for (int64_t path = begin; path < end; ++path) {
      const size_t grid = grid_[static_cast<size_t>(path)];
      lists[grid][places[grid]++] = path;
    }
  }

  size_t num_grids_;
  std::vector<uint8_t> grid_;                // by path
  std::vector<std::vector<size_t>> place_;   // [task][grid]
  std::vector<std::vector<int64_t>> lists_;
};

// Returns the paths less those that were left, in their order.
std::vector<int64_t> without(const std::vector<UnfollowedPath>& left, std::span<const int64_t> paths) {
  std::vector<int64_t> rest;
  rest.reserve(paths.size());
  auto next = paths.begin();
  for (const UnfollowedPath& failed : left) {
    const auto end = std::find(next, paths.end(), failed.path);
    rest.insert(rest.end(), next, end);
    next = end + 1;
  }
  rest.insert(rest.end(), next, paths.end());
  return rest;
}

}  // namespace

struct ReplayStream::Block {
  std::vector<Echoes> channels;
  std::vector<int64_t> paths;    // [echo] its path, or the first of those joined in it
  int64_t num_paths = 0;         // of all echoes
  std::vector<UnfollowedPath> left;
};

// Holds blocks that are replayed together.
struct ReplayStream::Window {
  int first_channel = 0;
  size_t num_channels = 0;
  std::vector<Block> blocks;
};

// Hands windows to the sink, each while the next is replayed.
class ReplayStream::WindowPipeline {
 public:
  WindowPipeline(const ReplayStream& stream, const Sink& sink) : stream_(stream), sink_(sink) {}

  // Hands the last window to the sink while `replay` makes the next, each with whatever threads the other leaves idle.
  void beside(const std::function<void(Window& next)>& replay) {
    Window next;
    run_both([&] { finish(); }, [&] { replay(next); });
    last_ = std::move(next);
  }

  void finish() {
    std::vector<int64_t> paths;
    int64_t num_paths = 0;
    for (const Block& block : last_.blocks) {
      paths.insert(paths.end(), block.paths.begin(), block.paths.end());
      num_paths += block.num_paths;
    }
    std::vector<Echoes> echoes(last_.blocks.size());
    for (size_t channel = 0; channel < last_.num_channels; ++channel) {
      if (stream_.job_) stream_.job_->throw_if_cancelled();
      for (size_t i = 0; i < echoes.size(); ++i) echoes[i] = std::move(last_.blocks[i].channels[channel]);
      sink_(last_.first_channel + static_cast<int>(channel), echoes, {paths, num_paths});
      stream_.replayer_.recycle(echoes);
    }
    last_ = {};
  }

 private:
  const ReplayStream& stream_;
  const Sink& sink_;
  Window last_;
};

void ReplayStream::run(const Sink& sink) const {
  WindowPipeline out(*this, sink);
  const PathGrids grids = replayer_.path_grids();
  std::vector<std::vector<int64_t>> by_grid = PathsByGrid(grids, num_paths_, job_).take();
  add_still(by_grid.front(), out);
  by_grid.front() = {};
  add_moving(grids, std::move(by_grid), out);
  out.finish();
}

void ReplayStream::add_still(const std::vector<int64_t>& paths, WindowPipeline& out) const {
  run_blocks(paths, {0, num_channels(), 1}, [&](auto part, auto, auto&) { return replayer_.still(part); }, out);
}

// Replays each path at the polynomial that its meshes need; where that was not enough, at the next, or with its amplitude in
// every chirp.
void ReplayStream::add_moving(const PathGrids& grids, std::vector<std::vector<int64_t>> by_grid, WindowPipeline& out) const {
  std::vector<std::vector<int64_t>> by_chirp(by_grid.size());
  for (int polynomial = 1; polynomial <= replayer_.grids().num_polynomials(); ++polynomial) {
    const Extent extent{0, num_channels(), replayer_.grids().polynomial(polynomial).num_nodes};
    const Replay replay = [&](auto part, auto, auto& left) { return replayer_.interpolated(part, polynomial, left); };
    for (const UnfollowedPath& path : run_blocks(by_grid[static_cast<size_t>(polynomial)], extent, replay, out)) {
      const NextGrid next = grids.next(path, polynomial);
      (next.by_chirp ? by_chirp : by_grid)[static_cast<size_t>(next.polynomial)].push_back(path.path);
    }
  }
  for (int transmitter = 0; transmitter < num_transmitters_; ++transmitter) {
    add_chirps(by_chirp, transmitter, out);
    add_samples(by_grid.back(), transmitter, out);
  }
}

// Holds only the scene as posed at the chirps of one transmitter.
void ReplayStream::add_chirps(const std::vector<std::vector<int64_t>>& by_grid, int transmitter, WindowPipeline& out) const {
  const auto is_empty = [](const std::vector<int64_t>& paths) { return paths.empty(); };
  if (std::all_of(by_grid.begin(), by_grid.end(), is_empty)) return;
  const int num_receivers = num_channels() / num_transmitters_;
  const Extent extent{transmitter * num_receivers, num_receivers, replayer_.num_rows_by_chirp(), true};
  const PosedGrid chirps = replayer_.pose(replayer_.grids().chirps(transmitter));
  for (int polynomial = 1; polynomial <= replayer_.grids().num_polynomials(); ++polynomial) {
    run_blocks(by_grid[static_cast<size_t>(polynomial)], extent,
               [&](auto part, auto joined, auto&) { return replayer_.by_chirp(part, polynomial, chirps, joined); }, out);
  }
}

// Replays the paths that no polynomial follows.
void ReplayStream::add_samples(const std::vector<int64_t>& paths, int transmitter, WindowPipeline& out) const {
  if (paths.empty()) return;
  const int num_receivers = num_channels() / num_transmitters_;
  const PosedGrid samples = replayer_.pose(replayer_.grids().samples(transmitter));
  run_blocks(paths, {transmitter * num_receivers, num_receivers, replayer_.grids().num_sample_nodes()},
             [&](auto part, auto, auto&) { return replayer_.exact(part, samples); }, out);
}

// Replays blocks in parallel, a fixed number at a time. Returns the paths that `replay` left.
std::vector<UnfollowedPath> ReplayStream::run_blocks(const std::vector<int64_t>& paths, const Extent& extent, const Replay& replay,
                                                 WindowPipeline& out) const {
  const int64_t size = block_size(extent.num_channels, extent.num_rows), num_paths = static_cast<int64_t>(paths.size());
  std::vector<UnfollowedPath> all_left;
  for (int64_t begin = 0; begin < num_paths; begin += size * kBlocksInFlight) {
    const int64_t count = std::min(size * kBlocksInFlight, num_paths - begin);
    const std::span<const int64_t> some(paths.data() + begin, static_cast<size_t>(count));
    out.beside([&](Window& window) {
      const std::vector<UnfollowedPath> left = replay_window(some, size, extent, replay, window);
      all_left.insert(all_left.end(), left.begin(), left.end());
    });
  }
  return all_left;
}

// Replays a window of blocks. Returns the paths that are left.
std::vector<UnfollowedPath> ReplayStream::replay_window(std::span<const int64_t> paths, int64_t block_size,
                                                    const Extent& extent, const Replay& replay, Window& window) const {
  const int64_t count = static_cast<int64_t>(paths.size()), num_blocks = (count + block_size - 1) / block_size;
  window.first_channel = extent.first_channel;
  window.num_channels = static_cast<size_t>(extent.num_channels);
  window.blocks.resize(static_cast<size_t>(num_blocks));
  parallel_for(num_blocks, [&](int64_t i) {
    if (job_) job_->throw_if_cancelled();
    const int64_t first = i * block_size;
    const auto part = paths.subspan(static_cast<size_t>(first), static_cast<size_t>(std::min(block_size, count - first)));
    window.blocks[static_cast<size_t>(i)] = run_block(part, static_cast<size_t>(i), extent, replay);
  });
  if (watcher_) watcher_->end_blocks();
  std::vector<UnfollowedPath> all_left;
  for (const Block& block : window.blocks) all_left.insert(all_left.end(), block.left.begin(), block.left.end());
  return all_left;
}

bool ReplayStream::is_watched(const Extent& extent) const {
  for (int i = 0; watcher_ && i < extent.num_channels; ++i) {
    if (watcher_->watches(extent.first_channel + i)) return true;
  }
  return false;
}

ReplayStream::Block ReplayStream::run_block(std::span<const int64_t> paths, size_t index, const Extent& extent,
                                            const Replay& replay) const {
  Block block;
  std::vector<uint8_t> joined;
  const bool joins_at_once = join_rule_ && extent.joins && !is_watched(extent);
  if (joins_at_once) joined = (*join_rule_)(paths);
  block.channels = replay(paths, joined, block.left);
  block.paths = without(block.left, paths);
  block.num_paths = static_cast<int64_t>(block.paths.size());
  if (!joins_at_once) {
    for (int i = 0; watcher_ && i < extent.num_channels; ++i) {
      const int channel = extent.first_channel + i;
      if (watcher_->watches(channel)) watcher_->see(channel, index, block.channels[static_cast<size_t>(i)], block.paths);
    }
    if (!join_rule_) return block;
    joined = (*join_rule_)(block.paths);
    block.channels = replayer_.joined(std::move(block.channels), joined);
  }
  block.paths = first_of(block.paths, joined);
  return block;
}

namespace {

// Evaluates all chirps of echoes [begin, end), which are few, so that their nodes stay in the first-level cache.
void evaluate_chirps(const Echoes& echoes, int64_t begin, int64_t end, int num_chirps) {
  constexpr int kChirpsAtOnce = 4;
  EchoStates states[kChirpsAtOnce];
  for (int chirp = 0; chirp < num_chirps; chirp += kChirpsAtOnce) {
    evaluate_states(echoes, chirp, std::min(kChirpsAtOnce, num_chirps - chirp), begin, static_cast<int>(end - begin), states);
  }
}

}  // namespace

int64_t replay_only(const Paths& paths, const Radar& radar, const ReplaySettings& settings, Job* job) {
  constexpr int64_t kEchoes = EchoStates::kCapacity / 4;
  ReplayStream stream(paths, radar, settings, job);
  stream.join({});
  int64_t path_chirps = 0;
  stream.run([&](int, std::span<Echoes> blocks, const ReplayStream::EchoPaths& of) {
    const int num_chirps = blocks.front().sampling.is_static() ? 1 : radar.waveform.num_chirps;
    path_chirps += of.count * num_chirps;
    for (const Echoes& echoes : blocks) {
      parallel_for((echoes.num_echoes + kEchoes - 1) / kEchoes, [&](int64_t i) {
        evaluate_chirps(echoes, i * kEchoes, std::min(echoes.num_echoes, (i + 1) * kEchoes), num_chirps);
      });
    }
  });
  return path_chirps;
}

namespace {

// Compares one block of one channel with its values at the given chirps.
class ErrorOfBlock {
 public:
  ErrorOfBlock(const Replayer& replayer, const Paths& paths, const Radar& radar, int channel)
      : replayer_(replayer), paths_(paths), radar_(radar), channel_(channel) {}

  void find(const Echoes& echoes, std::span<const int64_t> indices, const std::vector<int>& chirps, ReplayError& error) {
    std::vector<double> largest(indices.size()), worst(indices.size());  // amplitudes
    for (const int chirp : chirps) {
      evaluate(indices, chirp);
      for (size_t p = 0; p < indices.size(); ++p) compare(echoes, chirp, p, largest[p], worst[p], error);
    }
    for (size_t p = 0; p < indices.size(); ++p) {
      if (largest[p] > 0.0) error.amplitude = std::max(error.amplitude, worst[p] / largest[p]);
    }
  }

 private:
  void evaluate(std::span<const int64_t> indices, int chirp) {
    const auto transmitter = static_cast<int>(static_cast<size_t>(channel_) / radar_.receivers.size());
    const double time = paths_.frame.start_time + radar_.chirp_time(transmitter, chirp);
    replayer_.evaluate(indices, time, lengths_, amplitudes_);
    const auto begin = static_cast<ptrdiff_t>(static_cast<size_t>(channel_) * indices.size()), end = begin + static_cast<ptrdiff_t>(indices.size());
    lengths_ = {lengths_.begin() + begin, lengths_.begin() + end};
    amplitudes_ = {amplitudes_.begin() + begin, amplitudes_.begin() + end};
  }

  void compare(const Echoes& echoes, int chirp, size_t p, double& largest, double& worst, ReplayError& error) const {
    EchoStates state;
    evaluate_states(echoes, chirp, static_cast<int64_t>(p), 1, state);
    const std::complex<double> amplitude(state.amplitude[0], state.amplitude[1]);
    if (amplitude == 0.0) return;  // dark
    const double wavenumber = kTwoPi * radar_.waveform.start_frequency / kSpeedOfLight;
    error.phase = std::max(error.phase, wavenumber * std::abs(kSpeedOfLight * state.delay[0] - lengths_[p]));
    largest = std::max(largest, std::abs(amplitudes_[p]));
    worst = std::max(worst, std::abs(amplitude - amplitudes_[p]));
  }

  const Replayer& replayer_;
  const Paths& paths_;
  const Radar& radar_;
  int channel_;
  std::vector<double> lengths_;
  std::vector<std::complex<double>> amplitudes_;
};

}  // namespace

ReplayError replay_error(const Paths& paths, const Radar& radar, const ReplaySettings& settings, const std::vector<int>& chirps,
                         Job* job) {
  for (const int chirp : chirps) {
    require(chirp >= 0 && chirp < radar.waveform.num_chirps, "chirps", "must be chirps of the radar", chirp);
  }
  const ReplayStream stream(paths, radar, settings, job);
  ReplayError error;
  stream.run([&](int channel, std::span<Echoes> blocks, const ReplayStream::EchoPaths& of) {
    std::span<const int64_t> indices = of.first;
    for (const Echoes& echoes : blocks) {
      const auto count = static_cast<size_t>(echoes.num_echoes);
      ErrorOfBlock(stream.replayer(), paths, radar, channel).find(echoes, indices.first(count), chirps, error);
      indices = indices.subspan(count);
    }
  });
  return error;
}

}  // namespace echopath
