#include "echopath/sim/replay_stream.h"

#include <algorithm>
#include <utility>

#include "echopath/base/large_array.h"
#include "echopath/base/parallel.h"
#include "echopath/signal/echoes.h"

namespace echopath {
namespace {

constexpr int64_t kBlocksInFlight = ReplayStream::kBlocksInFlight;
constexpr int64_t kEchoesInFlight = 1 << 17;   // paths x channels; as many are handed over meanwhile
constexpr int64_t kNodesOfAPath = 32;          // that these echoes may have each before there are fewer of them
// What a block has at its nodes stays in the second-level cache. No power of two: rows of nodes would share the sets of the first.
constexpr int64_t kLargestBlock = 1000;

// Echoes with nodes in every chirp: few at a time, whose memory the next take over; a page that is touched for the first time costs
// as much as a path does at all its nodes.
constexpr int64_t kNodesOfChirps = 128;
constexpr int64_t kValuesInFlight = 150000;  // no power of two, likewise
constexpr int64_t kLeastBlock = 64;  // as many vectors of echoes, once they are joined, as fill the registers

int64_t block_size(int64_t num_channels, int64_t num_nodes) {
  const int64_t values = num_channels * std::max<int64_t>(1, num_nodes / kNodesOfAPath);
  const int64_t most = std::clamp<int64_t>(kEchoesInFlight / (kBlocksInFlight * values), 1, kLargestBlock);
  if (num_nodes <= kNodesOfChirps) return most;
  return std::min(most, std::max(kLeastBlock, kValuesInFlight / (kBlocksInFlight * num_channels * num_nodes)));
}

constexpr int64_t kPathsOfTask = 1 << 13;  // whose levels are found

// Indices of the paths by level, in their order; at level 0 those on which nothing moves.
class PathsByLevel {
 public:
  PathsByLevel(const NodeLevels& levels, int64_t num_paths, Job* job)
      : num_levels_(static_cast<size_t>(levels.num_polynomials()) + 2), level_(static_cast<size_t>(num_paths)) {
    const int64_t num_tasks = (num_paths + kPathsOfTask - 1) / kPathsOfTask;
    place_.assign(static_cast<size_t>(num_tasks), std::vector<size_t>(num_levels_));
    parallel_for(num_tasks, [&](int64_t task) {
      if (job) job->throw_if_cancelled();
      find_levels(levels, task);
    });
    std::vector<std::vector<int64_t>> lists = lists_of_counts();
    parallel_for(num_tasks, [&](int64_t task) { fill(task, lists); });
    lists_ = std::move(lists);
  }

  std::vector<std::vector<int64_t>> take() { return std::move(lists_); }

 private:
  std::pair<int64_t, int64_t> range_of(int64_t task) const {
    return {task * kPathsOfTask, std::min<int64_t>((task + 1) * kPathsOfTask, static_cast<int64_t>(level_.size()))};
  }

  void find_levels(const NodeLevels& levels, int64_t task) {
    const auto [begin, end] = range_of(task);
    const std::span<uint8_t> here(level_.data() + begin, static_cast<size_t>(end - begin));
    levels.first_levels(begin, here);
    for (const uint8_t level : here) ++place_[static_cast<size_t>(task)][level];
  }

  // Makes counts of the tasks the places where each begins to write.
  std::vector<std::vector<int64_t>> lists_of_counts() {
    std::vector<size_t> sizes(num_levels_);
    for (std::vector<size_t>& places : place_) {
      for (size_t level = 0; level < num_levels_; ++level) sizes[level] += std::exchange(places[level], sizes[level]);
    }
    std::vector<std::vector<int64_t>> lists(num_levels_);
    for (size_t level = 0; level < num_levels_; ++level) resize_large(lists[level], sizes[level]);
    return lists;
  }

  void fill(int64_t task, std::vector<std::vector<int64_t>>& lists) {
    const auto [begin, end] = range_of(task);
    std::vector<size_t>& places = place_[static_cast<size_t>(task)];
    for (int64_t path = begin; path < end; ++path) {
      const size_t level = level_[static_cast<size_t>(path)];
      lists[level][places[level]++] = path;
    }
  }

  size_t num_levels_;
  std::vector<uint8_t> level_;               // by path
  std::vector<std::vector<size_t>> place_;   // [task][level]
  std::vector<std::vector<int64_t>> lists_;
};

// Paths less those that were left, in their order.
std::vector<int64_t> without(const std::vector<FailedPath>& left, std::span<const int64_t> paths) {
  std::vector<int64_t> rest;
  rest.reserve(paths.size());
  auto next = paths.begin();
  for (const FailedPath& failed : left) {
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
  std::vector<int64_t> paths;    // of each echo, the first
  int64_t num_paths = 0;         // of all echoes
  std::vector<FailedPath> left;
};

// Blocks that are replayed together.
struct ReplayStream::Window {
  int first_channel = 0;
  size_t num_channels = 0;
  std::vector<Block> blocks;
};

// The way to the sink.
class ReplayStream::HandOver {
 public:
  HandOver(const ReplayStream& stream, const Sink& sink) : stream_(stream), sink_(sink) {}

  // The last window goes to the sink while `replay` makes the next, with whatever threads either leaves idle.
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
  HandOver out(*this, sink);
  std::vector<std::vector<int64_t>> by_level = PathsByLevel(replayer_.levels(), num_paths_, job_).take();
  add_still(by_level.front(), out);
  by_level.front() = {};
  add_moving(std::move(by_level), out);
  out.finish();
}

void ReplayStream::add_still(const std::vector<int64_t>& paths, HandOver& out) const {
  run_blocks(paths, {0, num_channels(), 1}, [&](auto part, auto, auto&) { return replayer_.still(part); }, out);
}

// Each path at the order that its meshes need; where that was not enough, at the next, or its amplitude in every chirp.
void ReplayStream::add_moving(std::vector<std::vector<int64_t>> by_level, HandOver& out) const {
  const NodeLevels& levels = replayer_.levels();
  std::vector<std::vector<int64_t>> by_chirp(by_level.size());
  for (int level = 1; level <= levels.num_polynomials(); ++level) {
    const Extent extent{0, num_channels(), levels.num_nodes(level)};
    const Replay replay = [&](auto part, auto, std::vector<FailedPath>& left) { return replayer_.interpolated(part, level, left); };
    for (const FailedPath& failed : run_blocks(by_level[static_cast<size_t>(level)], extent, replay, out)) {
      (failed.by_chirp ? by_chirp : by_level)[static_cast<size_t>(failed.next_level)].push_back(failed.path);
    }
  }
  by_chirp.back() = std::move(by_level.back());
  for (int transmitter = 0; transmitter < num_transmitters_; ++transmitter) add_chirps(by_chirp, transmitter, out);
}

// The scene as posed at the chirps of one transmitter is all that is held. At the last level stand paths that no polynomial follows.
void ReplayStream::add_chirps(const std::vector<std::vector<int64_t>>& by_level, int transmitter, HandOver& out) const {
  const NodeLevels& levels = replayer_.levels();
  const int num_receivers = num_channels() / num_transmitters_, first = transmitter * num_receivers;
  for (int level = 1; level <= levels.num_polynomials(); ++level) {
    run_blocks(by_level[static_cast<size_t>(level)], {first, num_receivers, replayer_.num_nodes_by_chirp(), true},
               [&](auto part, auto joined, auto&) { return replayer_.by_chirp(part, level, transmitter, joined); }, out);
  }
  run_blocks(by_level.back(), {first, num_receivers, levels.num_exact_nodes()},
             [&](auto part, auto, auto&) { return replayer_.exact(part, transmitter); }, out);
  levels.forget_chirps(transmitter);
}

// Blocks are replayed in parallel, a fixed number at a time. Returns the paths that `replay` left.
std::vector<FailedPath> ReplayStream::run_blocks(const std::vector<int64_t>& paths, const Extent& extent, const Replay& replay,
                                                 HandOver& out) const {
  const int64_t size = block_size(extent.num_channels, extent.num_nodes), num_paths = static_cast<int64_t>(paths.size());
  std::vector<FailedPath> all_left;
  for (int64_t begin = 0; begin < num_paths; begin += size * kBlocksInFlight) {
    const int64_t count = std::min(size * kBlocksInFlight, num_paths - begin);
    const std::span<const int64_t> some(paths.data() + begin, static_cast<size_t>(count));
    out.beside([&](Window& window) {
      const std::vector<FailedPath> left = replay_window(some, size, extent, replay, window);
      all_left.insert(all_left.end(), left.begin(), left.end());
    });
  }
  return all_left;
}

// Returns what is left of these paths.
std::vector<FailedPath> ReplayStream::replay_window(std::span<const int64_t> paths, int64_t block_size,
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
  std::vector<FailedPath> all_left;
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

}  // namespace echopath
