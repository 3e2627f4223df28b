#pragma once
// Sends blocks of paths through replay to synthesis.
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "echopath/replay/replay.h"
#include "echopath/sim/stream/flights.h"
#include "echopath/sim/stream/paths_by_grid.h"

namespace echopath {

// Receives the echo of every path by itself, before echoes of several paths are joined.
class PathWatcher {
 public:
  virtual ~PathWatcher() = default;
  virtual bool watches(int channel) const = 0;
  // Receives one of the blocks in flight; `block` is below kMostBlocksOfFlight. Many threads call it at a time,
  // each with a block of its own.
  virtual void see(int channel, size_t block, const Echoes& echoes, std::span<const int64_t> paths) = 0;
  // Ends a group of blocks: the stream calls it once see() has had all blocks in flight.
  virtual void end_blocks() = 0;
};

// Replays paths and sends their echoes to a sink, many blocks at a time. Blocks and their order depend on the paths and the
// number of channels alone.
class ReplayStream {
 public:
  // Tells which paths the echoes of some blocks belong to.
  struct EchoPaths {
    std::span<const int64_t> first;  // [echo], one block after the other: its path, or the first of those joined in it
    int64_t count;                   // of all paths, with those that are negligible and have no echo
  };
  // Takes the blocks of one channel, which it may change. Each path comes at most once for each channel.
  using Sink = std::function<void(int channel, std::span<Echoes> blocks, const EchoPaths& paths)>;

  // `paths` and `radar` must outlive the stream. Raises as Replayer.
  ReplayStream(const Paths& paths, const Radar& radar, const ReplaySettings& settings, Job* job)
      : num_paths_(paths.num_paths()), num_transmitters_(static_cast<int>(radar.transmitters.size())),
        replayer_(paths, radar, settings), job_(job), kept_chirps_(radar.transmitters.size()),
        kept_samples_(radar.transmitters.size()) {}

  // Joins paths over the same hits to one echo where they agree in all of `labels` ([P] each, which must outlive the
  // stream), except paths whose logarithms are interpolated (Replayer::turning). It holds for the blocks that are sent
  // afterwards.
  void join(std::vector<const std::vector<uint32_t>*> labels) { join_rule_.emplace(replayer_.join_rule(std::move(labels))); }
  // Sets the watcher of paths, which must outlive the stream.
  void watch(PathWatcher* watcher) { watcher_ = watcher; }

  static constexpr int64_t kKeptSamples = 256 << 20;  // bytes
  int num_channels() const { return replayer_.num_channels(); }
  const Replayer& replayer() const { return replayer_; }
  // Sends the paths to the sink, all of them or some (indices, of which those that are to be joined follow each other). A
  // stream that sends some at a time keeps the meshes as posed in each chirp, where paths need them, and at the samples of
  // all chirps where that is no more than kKeptSamples. Large arrays take all paths for a few of their transmitters, then
  // for the next. Memory is bounded by the blocks in flight, 0.2 GiB of delays and amplitudes at 32 nodes a path (a third
  // more of logarithms, for their turns), whatever the number of paths, chirps and channels; a sink that sorts them needs at
  // most as much again. Beside these each thread works on 320 B for each channel and node of a block
  // (SingleBounceEvaluation), and on what chains of its paths share. `sink` is called from one thread at a time, while the
  // next blocks are replayed. Raises Cancelled.
  void run(const Sink& sink);
  void run(std::span<const int64_t> paths, const Sink& sink);
  // Sets the job that later calls of run() report to and that can cancel them.
  void set_job(Job* job) { job_ = job; }

 private:
  using Replay = std::function<std::vector<Echoes>(std::span<const int64_t> paths, std::span<const uint8_t> joined,
                                                   std::vector<UnfollowedPath>& left)>;
  // Describes the channels that `replay` makes echoes of, the number of rows, whether it joins paths itself on request, and
  // whether echoes hold logarithms, which cannot be joined.
  struct Extent {
    int first_channel, num_channels;
    int64_t num_rows;
    bool joins = false, has_logarithms = false;
  };
  struct Block;
  struct Work;
  struct Window;
  class WindowPipeline;
  int num_receivers() const { return num_channels() / num_transmitters_; }
  Extent extent_of_all(int64_t num_rows) const;
  void run(const PathGrids& grids, PathsByGrid by_grid, const Sink& sink);
  void replay_polynomials(const PathGrids& grids, PathsByGrid& by_grid, PathsByGrid& by_chirp, WindowPipeline& out);
  std::vector<Work> still_works(std::vector<int64_t>& paths);
  void append_polynomials(PathsByGrid& by_grid, std::vector<Work>& works);
  void replay_turning(std::vector<Work>& works, WindowPipeline& out) const;
  void replay_in_chirps(const PathsByGrid& by_chirp, const std::vector<int64_t>& by_sample, WindowPipeline& out);
  void append_chirps(const PathsByGrid& by_grid, int transmitter, std::vector<Work>& works);
  void append_samples(const std::vector<int64_t>& paths, int transmitter, std::vector<Work>& works);
  const PosedGrid& posed(const TimeGrid& grid, std::span<const int64_t> paths, std::unique_ptr<PartlyPosedGrid>& kept) const;
  void replay_all(std::vector<Work>& works, WindowPipeline& out) const;
  std::vector<Window> replay_flight(std::vector<Work>& works, const Flight& flight) const;
  bool is_watched(const Extent& extent) const;
  Block run_block(std::span<const int64_t> paths, size_t index, const Extent& extent, const Replay& replay) const;

  int64_t num_paths_;
  int num_transmitters_;
  Replayer replayer_;
  Job* job_;
  std::optional<JoinRule> join_rule_;
  PathWatcher* watcher_ = nullptr;
  SomeTransmitters transmitters_;  // whose turn it is
  // These hold time grids and posed meshes from one run over a part of the paths to the next.
  std::optional<PathGrids> kept_grids_;
  bool keeps_poses_ = false;
  std::vector<std::unique_ptr<PartlyPosedGrid>> kept_chirps_, kept_samples_;  // by transmitter, null where none are kept
};

}  // namespace echopath
