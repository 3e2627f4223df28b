#pragma once
// Blocks of paths on their way through replay.
#include <functional>
#include <span>
#include <vector>

#include "echopath/replay/replay.h"

namespace echopath {

// Hands the echoes of all paths over in an order and in blocks that depend on the paths alone, many blocks at a time.
class ReplayStream {
 public:
  // Blocks of one channel, which may be changed, and the indices of the paths of all of them, one after the other. Each path
  // comes once.
  using Sink = std::function<void(int channel, std::span<Echoes> blocks, std::span<const int64_t> indices)>;

  // Paths and radar must outlive the stream. Raises what Replayer does.
  ReplayStream(const Paths& paths, const Radar& radar, const ReplaySettings& settings, Job* job)
      : num_paths_(paths.num_paths()), num_transmitters_(static_cast<int>(radar.transmitters.size())),
        replayer_(paths, radar, settings), job_(job) {}

  int num_channels() const { return replayer_.num_channels(); }
  const Replayer& replayer() const { return replayer_; }
  // Memory is bounded by the blocks in flight, 0.2 GiB of delays and amplitudes at 32 nodes a path, whatever the number of
  // paths, chirps and channels; a sink that sorts them needs at most as much again. `sink` is called from one thread at a
  // time, while the next blocks are replayed. Raises Cancelled.
  void run(const Sink& sink) const;

 private:
  using Replay = std::function<std::vector<Echoes>(std::span<const int64_t>, std::vector<FailedPath>&)>;
  struct Window;
  class HandOver;
  void add_still(const std::vector<int64_t>& paths, HandOver& out) const;
  void add_moving(std::vector<std::vector<int64_t>> by_level, HandOver& out) const;
  void add_chirps(const std::vector<std::vector<int64_t>>& by_level, int transmitter, HandOver& out) const;
  // Channels that `replay` makes echoes of, at how many nodes.
  struct Extent {
    int first_channel, num_channels;
    int64_t num_nodes;
  };
  std::vector<FailedPath> run_blocks(const std::vector<int64_t>& paths, const Extent& extent, const Replay& replay,
                                     HandOver& out) const;
  std::vector<FailedPath> replay_window(std::span<const int64_t> paths, int64_t block_size, const Extent& extent,
                                        const Replay& replay, Window& window) const;

  int64_t num_paths_;
  int num_transmitters_;
  Replayer replayer_;
  Job* job_;
};

// Replays all paths at every chirp and for every channel, without synthesis, to see what that costs. Returns the number of
// path-chirps, static paths once.
int64_t replay_only(const Paths& paths, const Radar& radar, const ReplaySettings& settings, Job* job = nullptr);

// Largest differences between replay with these settings and evaluation at the middle of chirps.
struct ReplayError {
  double phase = 0.0;      // rad, at the start frequency
  double amplitude = 0.0;  // relative to the largest amplitude of the path in these chirps
};

// In `chirps` (indices), over all paths and channels, each path where it follows its tolerances. Raises Cancelled.
ReplayError replay_error(const Paths& paths, const Radar& radar, const ReplaySettings& settings, const std::vector<int>& chirps,
                         Job* job = nullptr);

}  // namespace echopath
