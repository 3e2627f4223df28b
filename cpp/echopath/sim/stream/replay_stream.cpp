#include "echopath/sim/stream/replay_stream.h"

#include <algorithm>
#include <utility>

#include "echopath/base/threads/parallel.h"
#include "echopath/signal/echoes/echoes.h"

namespace echopath {
namespace {

constexpr int64_t kBlocksInFlight = ReplayStream::kBlocksInFlight;
constexpr int64_t kEchoesInFlight = 1 << 18;  // paths x channels; as many are handed over meanwhile
constexpr int64_t kNodesOfAPath = 16;         // with more nodes per path, fewer echoes are in flight
// The values of a block at its nodes stay in the second-level cache. No power of two: rows of nodes would share the sets of
// the first.
constexpr int64_t kLargestBlock = 1000;

// Echoes with nodes in every chirp are replayed few at a time, and the next take over their memory: a page that is touched
// for the first time costs as much as a path does at all its nodes.
constexpr int64_t kNodesOfChirps = 128;
constexpr int64_t kValuesInFlight = 150000;  // no power of two, as above
constexpr int64_t kMinBlock = 64;            // fills the registers with vectors of joined echoes

constexpr int64_t kBlocksOfChirps = 16;  // in flight: 32, with their tiles, left the cache that all cores share

int64_t blocks_in_flight(int64_t num_rows) { return num_rows > kNodesOfChirps ? kBlocksOfChirps : kBlocksInFlight; }

int64_t block_size(int64_t num_channels, int64_t num_rows) {
  const int64_t values = num_channels * ((num_rows + kNodesOfAPath - 1) / kNodesOfAPath);
  const int64_t most = std::clamp<int64_t>(kEchoesInFlight / (blocks_in_flight(num_rows) * values), 1, kLargestBlock);
  if (num_rows <= kNodesOfChirps) return most;
  return std::min(most, std::max(kMinBlock, kValuesInFlight / (blocks_in_flight(num_rows) * num_channels * num_rows)));
}

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
  std::vector<int64_t> paths;  // [echo] its path, or the first of those joined in it
  int64_t num_paths = 0;       // of all echoes, and those that are negligible
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

void ReplayStream::run(const Sink& sink) {
  const PathGrids grids = replayer_.path_grids();
  run(grids, paths_by_grid(grids, num_paths_, job_), sink);
}

void ReplayStream::run(std::span<const int64_t> paths, const Sink& sink) {
  if (!kept_grids_) kept_grids_.emplace(replayer_.path_grids());
  keeps_poses_ = true;
  run(*kept_grids_, paths_by_grid(*kept_grids_, paths, job_), sink);
}

void ReplayStream::run(const PathGrids& grids, PathsByGrid by_grid, const Sink& sink) {
  WindowPipeline out(*this, sink);
  add_still(by_grid.front(), out);
  by_grid.front() = std::vector<int64_t>();  // gives its memory back, which {} would keep
  add_moving(grids, std::move(by_grid), out);
  out.finish();
}

void ReplayStream::add_still(const std::vector<int64_t>& paths, WindowPipeline& out) {
  if (!paths.empty()) replayer_.pose_still();
  run_blocks(paths, {0, num_channels(), 1}, [&](auto part, auto, auto&) { return replayer_.still(part); }, out);
}

// Replays each path at the polynomial that its meshes need; where that was not enough, at the next, or with its amplitude in
// every chirp.
void ReplayStream::add_moving(const PathGrids& grids, PathsByGrid by_grid, WindowPipeline& out) {
  PathsByGrid by_chirp = no_paths_by_grid(replayer_.grids());
  const auto is_empty = [](const std::vector<int64_t>& some) { return some.empty(); };
  if (!std::all_of(by_grid.begin() + 1, by_grid.end(), is_empty)) replayer_.find_strongest();
  for (const GridIndex polynomial : replayer_.grids().polynomials()) {
    std::vector<int64_t>& paths = by_grid[polynomial.place()];
    if (paths.empty()) continue;
    const Extent extent{0, num_channels(), replayer_.grids().polynomial(polynomial).num_nodes};
    replayer_.pose_polynomial(polynomial, paths);
    const Replay replay = [&](auto part, auto, auto& left) { return replayer_.interpolated(part, polynomial, left); };
    for (const UnfollowedPath& path : without_turning(run_blocks(paths, extent, replay, out), polynomial, out)) {
      if (path.is_negligible) continue;
      const NextGrid next = grids.next(path, polynomial);
      (next.by_chirp ? by_chirp : by_grid)[next.grid.place()].push_back(path.path);
    }
    paths = std::vector<int64_t>();
  }
  for (int transmitter = 0; transmitter < num_transmitters_; ++transmitter) {
    add_chirps(by_chirp, transmitter, out);
    add_samples(by_grid[GridIndex::none().place()], transmitter, out);
  }
}

// Sends on those paths whose amplitudes the polynomial did not follow, but whose logarithms it does. Returns the others, in
// their order.
std::vector<UnfollowedPath> ReplayStream::without_turning(std::vector<UnfollowedPath> left, GridIndex polynomial,
                                                          WindowPipeline& out) const {
  std::vector<int64_t> may_turn;
  for (const UnfollowedPath& path : left) {
    const bool lacks_amplitude_alone = path.order_for_length == 0.0 && !path.is_negligible && !path.is_turned;
    if (lacks_amplitude_alone && replayer_.can_turn(path.path)) may_turn.push_back(path.path);
  }
  if (may_turn.empty()) return left;
  Extent extent{0, num_channels(), replayer_.grids().polynomial(polynomial).num_nodes};
  extent.has_logarithms = true;
  const Replay replay = [&](auto part, auto, auto& some) { return replayer_.turning(part, polynomial, some); };
  const std::vector<UnfollowedPath> unfollowed = run_blocks(may_turn, extent, replay, out);
  // Both lists are in the order of `left`.
  auto tried = may_turn.begin();
  auto failed = unfollowed.begin();
  std::vector<UnfollowedPath> rest;
  for (const UnfollowedPath& path : left) {
    const bool was_tried = tried != may_turn.end() && *tried == path.path;
    const bool has_failed = failed != unfollowed.end() && failed->path == path.path;
    if (was_tried) ++tried;
    if (has_failed) ++failed;
    if (!was_tried || has_failed) rest.push_back(path);
  }
  return rest;
}

// Holds only the scene as posed at the chirps of one transmitter.
void ReplayStream::add_chirps(const PathsByGrid& by_grid, int transmitter, WindowPipeline& out) {
  std::vector<int64_t> paths;
  for (const std::vector<int64_t>& of_grid : by_grid) paths.insert(paths.end(), of_grid.begin(), of_grid.end());
  if (paths.empty()) return;
  const int num_receivers = num_channels() / num_transmitters_;
  const Extent extent{transmitter * num_receivers, num_receivers, replayer_.num_rows_by_chirp(), true};
  std::unique_ptr<PartlyPosedGrid>& kept = kept_chirps_[transmitter];
  const PosedGrid& chirps = posed(replayer_.grids().chirps(transmitter), paths, kept);
  for (const GridIndex polynomial : replayer_.grids().polynomials()) {
    run_blocks(by_grid[polynomial.place()], extent,
               [&](auto part, auto joined, auto&) { return replayer_.by_chirp(part, polynomial, chirps, joined); }, out);
  }
  if (!keeps_poses_) kept.reset();
}

// Poses what the paths touch, beside what the grid had.
const PosedGrid& ReplayStream::posed(const TimeGrid& grid, std::span<const int64_t> paths,
                                     std::unique_ptr<PartlyPosedGrid>& kept) const {
  if (!kept) kept = std::make_unique<PartlyPosedGrid>(replayer_.pose_partly(grid));
  return kept->with(replayer_.meshes_of(paths));
}

// Replays the paths that no polynomial follows.
void ReplayStream::add_samples(const std::vector<int64_t>& paths, int transmitter, WindowPipeline& out) {
  if (paths.empty()) return;
  const int num_receivers = num_channels() / num_transmitters_;
  std::unique_ptr<PartlyPosedGrid>& kept = kept_samples_[transmitter];
  const PosedGrid& samples = posed(replayer_.grids().samples(transmitter), paths, kept);
  run_blocks(paths, {transmitter * num_receivers, num_receivers, replayer_.grids().num_sample_nodes()},
             [&](auto part, auto, auto&) { return replayer_.exact(part, samples); }, out);
  if (!keeps_poses_ || kept->num_bytes() * num_transmitters_ > kKeptSamples) kept.reset();
}

// Replays blocks in parallel, a fixed number at a time. Returns the paths that `replay` left.
std::vector<UnfollowedPath> ReplayStream::run_blocks(const std::vector<int64_t>& paths, const Extent& extent,
                                                     const Replay& replay, WindowPipeline& out) const {
  const int64_t size = block_size(extent.num_channels, extent.num_rows), num_paths = std::ssize(paths);
  std::vector<UnfollowedPath> all_left;
  const int64_t in_flight = size * blocks_in_flight(extent.num_rows);
  for (int64_t begin = 0; begin < num_paths; begin += in_flight) {
    const int64_t count = std::min(in_flight, num_paths - begin);
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
  window.first_channel = extent.first_channel;
  window.num_channels = static_cast<size_t>(extent.num_channels);
  window.blocks.resize(num_chunks(std::ssize(paths), block_size));
  parallel_for_chunks(std::ssize(paths), block_size, [&](int64_t begin, int64_t end) {
    if (job_) job_->throw_if_cancelled();
    const int64_t block = begin / block_size;
    window.blocks[block] = run_block(paths.subspan(begin, end - begin), block, extent, replay);
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
  const auto is_negligible = [](const UnfollowedPath& path) { return path.is_negligible; };
  block.num_paths = std::ssize(block.paths) + std::ranges::count_if(block.left, is_negligible);
  if (!joins_at_once) {
    for (int i = 0; watcher_ && i < extent.num_channels; ++i) {
      const int channel = extent.first_channel + i;
      if (watcher_->watches(channel)) watcher_->see(channel, index, block.channels[i], block.paths);
    }
    if (!join_rule_ || extent.has_logarithms) return block;
    joined = (*join_rule_)(block.paths);
    block.channels = replayer_.joined(std::move(block.channels), joined);
  }
  block.paths = first_of(block.paths, joined);
  return block;
}

}  // namespace echopath
