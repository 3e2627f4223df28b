#include "echopath/sim/stream/replay_stream.h"

#include <algorithm>
#include <utility>

#include "echopath/base/threads/parallel.h"
#include "echopath/signal/echoes/echoes.h"

namespace echopath {
namespace {

// Large arrays are replayed for so many channels at a time, unless one transmitter has more: the echoes of a block stay in
// the cache, and synthesis takes many paths of a channel at once. What is done once for each path takes little beside them.
constexpr int kChannelsTogether = 64;

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

// Returns the paths that were left less those that turned, in their order: of those that were `tried`, some `failed`. All
// three lists are in the same order.
std::vector<UnfollowedPath> without_turned(const std::vector<UnfollowedPath>& left, std::span<const int64_t> tried,
                                           const std::vector<UnfollowedPath>& failed) {
  std::vector<UnfollowedPath> rest;
  auto next_tried = tried.begin();
  auto next_failed = failed.begin();
  for (const UnfollowedPath& path : left) {
    const bool was_tried = next_tried != tried.end() && *next_tried == path.path;
    const bool has_failed = next_failed != failed.end() && next_failed->path == path.path;
    if (was_tried) ++next_tried;
    if (has_failed) ++next_failed;
    if (!was_tried || has_failed) rest.push_back(path);
  }
  return rest;
}

}  // namespace

struct ReplayStream::Block {
  std::vector<Echoes> channels;
  std::vector<int64_t> paths;  // [echo] its path, or the first of those joined in it
  int64_t num_paths = 0;       // of all echoes, and those that are negligible
  std::vector<UnfollowedPath> left;
};

// Describes paths that are replayed at the nodes of one grid.
struct ReplayStream::Work {
  Extent extent;
  Replay replay;
  GridIndex polynomial = GridIndex::none();  // that interpolates the paths, which then may be left
  std::span<const int64_t> paths;            // which outlive the work, or are its own
  std::vector<UnfollowedPath> left = {};
  std::vector<int64_t> own = {};

  static Work of_own(const Extent& extent, Replay replay, GridIndex polynomial, std::vector<int64_t> paths) {
    Work work{extent, std::move(replay), polynomial, {}};
    work.own = std::move(paths);
    work.paths = work.own;
    return work;
  }
};

// Holds blocks of one work that were in flight together.
struct ReplayStream::Window {
  Extent extent;
  std::vector<Block> blocks;
};

// Hands windows to the sink, those of a flight while the next one is replayed.
class ReplayStream::WindowPipeline {
 public:
  WindowPipeline(const ReplayStream& stream, const Sink& sink) : stream_(stream), sink_(sink) {}

  // Hands the last windows to the sink while `replay` makes the next, each with whatever threads the other leaves idle.
  void beside(const std::function<std::vector<Window>()>& replay) {
    std::vector<Window> next;
    run_both([&] { finish(); }, [&] { next = replay(); });
    last_ = std::move(next);
  }

  void finish() {
    for (Window& window : last_) hand_over(window);
    last_.clear();
  }

 private:
  void hand_over(Window& window) {
    std::vector<int64_t> paths;
    int64_t num_paths = 0;
    for (const Block& block : window.blocks) {
      paths.insert(paths.end(), block.paths.begin(), block.paths.end());
      num_paths += block.num_paths;
    }
    std::vector<Echoes> echoes(window.blocks.size());
    for (int channel = 0; channel < window.extent.num_channels; ++channel) {
      if (stream_.job_) stream_.job_->throw_if_cancelled();
      for (size_t i = 0; i < echoes.size(); ++i) echoes[i] = std::move(window.blocks[i].channels[channel]);
      sink_(window.extent.first_channel + channel, echoes, {paths, num_paths});
      stream_.replayer_.recycle(echoes);
    }
  }

  const ReplayStream& stream_;
  const Sink& sink_;
  std::vector<Window> last_;
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
  const int together = std::max(1, kChannelsTogether / num_receivers());
  for (int first = 0; first < num_transmitters_; first += together) {
    const int end = std::min(first + together, num_transmitters_);
    transmitters_ = {static_cast<size_t>(first), static_cast<size_t>(end - first)};
    // NOLINTNEXTLINE(bugprone-use-after-move): moved from in the last round alone
    PathsByGrid own = end < num_transmitters_ ? by_grid : std::move(by_grid);
    PathsByGrid by_chirp = no_paths_by_grid(replayer_.grids());
    replay_polynomials(grids, own, by_chirp, out);
    replay_in_chirps(by_chirp, own[GridIndex::none().place()], out);
  }
  out.finish();
}

// Replays what rests, and each other path at the polynomial that its meshes need. Where that was not enough, it is replayed
// at the next one in another round, or is added to `by_chirp`, if its amplitude is needed in every chirp, or to the paths
// that need samples.
void ReplayStream::replay_polynomials(const PathGrids& grids, PathsByGrid& by_grid, PathsByGrid& by_chirp,
                                      WindowPipeline& out) {
  const auto is_empty = [](const std::vector<int64_t>& some) { return some.empty(); };
  if (!std::all_of(by_grid.begin() + 1, by_grid.end(), is_empty)) replayer_.find_strongest();
  std::vector<Work> works = still_works(by_grid.front());
  for (;;) {
    append_polynomials(by_grid, works);
    if (works.empty()) return;
    replay_all(works, out);
    replay_turning(works, out);
    for (const Work& work : works) {
      for (const UnfollowedPath& path : work.left) {
        if (path.is_negligible) continue;
        const NextGrid next = grids.next(path, work.polynomial);
        (next.by_chirp ? by_chirp : by_grid)[next.grid.place()].push_back(path.path);
      }
    }
    works.clear();
  }
}

// Returns the extent of all channels of the transmitters whose turn it is.
ReplayStream::Extent ReplayStream::extent_of_all(int64_t num_rows) const {
  const auto first = static_cast<int>(transmitters_.first), count = static_cast<int>(transmitters_.count);
  return {first * num_receivers(), count * num_receivers(), num_rows};
}

// Takes the paths away, as the functions below do: their memory is given back once they are replayed.
std::vector<ReplayStream::Work> ReplayStream::still_works(std::vector<int64_t>& paths) {
  std::vector<Work> works;
  if (paths.empty()) return works;
  replayer_.pose_still();
  const Replay replay = [this](auto part, auto, auto&) { return replayer_.still(part, transmitters_); };
  works.push_back(Work::of_own(extent_of_all(1), replay, GridIndex::none(), std::exchange(paths, {})));
  return works;
}

void ReplayStream::append_polynomials(PathsByGrid& by_grid, std::vector<Work>& works) {
  for (const GridIndex polynomial : replayer_.grids().polynomials()) {
    std::vector<int64_t>& paths = by_grid[polynomial.place()];
    if (paths.empty()) continue;
    const Extent extent = extent_of_all(replayer_.grids().polynomial(polynomial).num_nodes);
    replayer_.pose_polynomial(polynomial, paths);
    const Replay replay = [this, polynomial](auto part, auto, auto& left) {
      return replayer_.interpolated(part, polynomial, left, transmitters_);
    };
    works.push_back(Work::of_own(extent, replay, polynomial, std::exchange(paths, {})));
  }
}

// Sends on those paths whose amplitudes the polynomial did not follow, but whose logarithms it does. The others stay left,
// in their order.
void ReplayStream::replay_turning(std::vector<Work>& works, WindowPipeline& out) const {
  std::vector<Work> turning;
  std::vector<size_t> source;  // [work of turning]
  for (size_t i = 0; i < works.size(); ++i) {
    std::vector<int64_t> may_turn;
    for (const UnfollowedPath& path : works[i].left) {
      const bool lacks_amplitude_alone = path.order_for_length == 0.0 && !path.is_negligible && !path.is_turned;
      if (lacks_amplitude_alone && replayer_.can_turn(path.path)) may_turn.push_back(path.path);
    }
    if (may_turn.empty()) continue;
    const GridIndex polynomial = works[i].polynomial;
    Extent extent = works[i].extent;
    extent.has_logarithms = true;
    const Replay replay = [this, polynomial](auto part, auto, auto& some) {
      return replayer_.turning(part, polynomial, some, transmitters_);
    };
    turning.push_back(Work::of_own(extent, replay, polynomial, std::move(may_turn)));
    source.push_back(i);
  }
  replay_all(turning, out);
  for (size_t k = 0; k < turning.size(); ++k) {
    std::vector<UnfollowedPath>& left = works[source[k]].left;
    left = without_turned(left, turning[k].paths, turning[k].left);
  }
}

// Replays what no polynomial follows in amplitude, or in length. Only the scene as posed for one transmitter is held, but
// where it is kept for the next paths.
void ReplayStream::replay_in_chirps(const PathsByGrid& by_chirp, const std::vector<int64_t>& by_sample,
                                    WindowPipeline& out) {
  std::vector<Work> works;
  const auto first = static_cast<int>(transmitters_.first), end = first + static_cast<int>(transmitters_.count);
  for (int transmitter = first; transmitter < end; ++transmitter) {
    append_chirps(by_chirp, transmitter, works);
    append_samples(by_sample, transmitter, works);
    const std::unique_ptr<PartlyPosedGrid>& samples = kept_samples_[transmitter];
    const bool keeps_samples = keeps_poses_ && (!samples || samples->num_bytes() * num_transmitters_ <= kKeptSamples);
    if (keeps_samples) continue;
    replay_all(works, out);
    works.clear();
    if (!keeps_poses_) kept_chirps_[transmitter].reset();
    kept_samples_[transmitter].reset();
  }
  replay_all(works, out);
}

void ReplayStream::append_chirps(const PathsByGrid& by_grid, int transmitter, std::vector<Work>& works) {
  std::vector<int64_t> all;
  for (const std::vector<int64_t>& of_grid : by_grid) all.insert(all.end(), of_grid.begin(), of_grid.end());
  if (all.empty()) return;
  const Extent extent{transmitter * num_receivers(), num_receivers(), replayer_.num_rows_by_chirp(), true};
  const PosedGrid& chirps = posed(replayer_.grids().chirps(transmitter), all, kept_chirps_[transmitter]);
  for (const GridIndex polynomial : replayer_.grids().polynomials()) {
    const std::vector<int64_t>& paths = by_grid[polynomial.place()];
    if (paths.empty()) continue;
    const Replay replay = [this, polynomial, &chirps](auto part, auto joined, auto&) {
      return replayer_.by_chirp(part, polynomial, chirps, joined);
    };
    works.push_back({extent, replay, polynomial, paths});
  }
}

// Appends the paths that no polynomial follows.
void ReplayStream::append_samples(const std::vector<int64_t>& paths, int transmitter, std::vector<Work>& works) {
  if (paths.empty()) return;
  const Extent extent{transmitter * num_receivers(), num_receivers(), replayer_.grids().num_sample_nodes()};
  const PosedGrid& samples = posed(replayer_.grids().samples(transmitter), paths, kept_samples_[transmitter]);
  const Replay replay = [this, &samples](auto part, auto, auto&) { return replayer_.exact(part, samples); };
  works.push_back({extent, replay, GridIndex::none(), paths});
}

// Poses what the paths touch, beside what the grid had.
const PosedGrid& ReplayStream::posed(const TimeGrid& grid, std::span<const int64_t> paths,
                                     std::unique_ptr<PartlyPosedGrid>& kept) const {
  if (!kept) kept = std::make_unique<PartlyPosedGrid>(replayer_.pose_partly(grid));
  return kept->with(replayer_.meshes_of(paths));
}

// Replays flight by flight, and adds the paths that a replay left to those of its work.
void ReplayStream::replay_all(std::vector<Work>& works, WindowPipeline& out) const {
  std::vector<PathsInFlight> lists;
  for (const Work& work : works) lists.push_back({std::ssize(work.paths), work.extent.num_channels, work.extent.num_rows});
  for (const Flight& flight : plan_flights(lists)) out.beside([&] { return replay_flight(works, flight); });
}

std::vector<ReplayStream::Window> ReplayStream::replay_flight(std::vector<Work>& works, const Flight& flight) const {
  std::vector<Block> blocks(flight.size());
  parallel_for(std::ssize(flight), [&](int64_t i) {
    if (job_) job_->throw_if_cancelled();
    const auto& [list, begin, end] = flight[i];
    const Work& work = works[list];
    blocks[i] = run_block(work.paths.subspan(begin, end - begin), i, work.extent, work.replay);
  });
  if (watcher_) watcher_->end_blocks();
  std::vector<Window> windows;
  for (size_t i = 0; i < flight.size(); ++i) {
    Work& work = works[flight[i].list];
    work.left.insert(work.left.end(), blocks[i].left.begin(), blocks[i].left.end());
    if (i == 0 || flight[i].list != flight[i - 1].list) windows.push_back({work.extent, {}});
    windows.back().blocks.push_back(std::move(blocks[i]));
  }
  return windows;
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
