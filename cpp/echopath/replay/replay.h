#pragma once
// Replay: what the recorded paths look like at other times and to other antennas, without tracing.
//
// Material points (diffuse hits and the physical-optics hit) move with their triangles, exactly; hits on flagged mirrors are
// replayed by images, exactly; other specular hits stay where they were recorded (second-order error in the slide) or move with
// the point of reflection by one Newton step (specular_slide.h).
#include <span>

#include "echopath/replay/evaluate/radio_constants.h"
#include "echopath/replay/joined_echoes.h"
#include "echopath/replay/time/node_levels.h"

namespace echopath {

// A path that a polynomial did not follow, and the level to go on with.
struct FailedPath {
  int64_t path;
  int next_level;
  bool by_chirp;  // Replayer::by_chirp goes on at that level: lengths do follow its polynomial
};

class Replayer {
 public:
  // The radar may differ from the one of the trace in its waveform, antennas and motion. Both must outlive the replayer.
  // Raises invalid_argument when a motion does not cover the frame.
  Replayer(const Paths& paths, const Radar& radar, const ReplaySettings& settings = {});

  int num_channels() const;
  const NodeLevels& levels() const { return levels_; }

  // Echoes of `paths` (indices), by channel [tx * num_rx + rx]; groups are left empty.
  // The paths must not move, nor must the radar: they are evaluated once, at the time of the trace.
  std::vector<Echoes> still(std::span<const int64_t> paths) const;
  // By the polynomial of `level`. Paths whose last two coefficients exceed a tolerance, of length or amplitude, are left out and
  // added to `failed`, in their order.
  std::vector<Echoes> interpolated(std::span<const int64_t> paths, int level, std::vector<FailedPath>& failed) const;
  // Of the channels of one transmitter [rx], at levels().num_exact_nodes() nodes: some in each of its chirps.
  std::vector<Echoes> exact(std::span<const int64_t> paths, int transmitter) const;
  // Likewise, at num_nodes_by_chirp() nodes: as they are in the middle of each chirp, with the derivatives of lengths by the
  // polynomial of `level`, which must follow them. What fades behind an edge of its surface has a root in its amplitude, which no
  // polynomial follows. Paths that are `joined` go into the echo of the one before (JoinRule); none where it is empty.
  std::vector<Echoes> by_chirp(std::span<const int64_t> paths, int level, int transmitter,
                               std::span<const uint8_t> joined = {}) const;
  int64_t num_nodes_by_chirp() const;

  // Which paths are to make one echo with others, unless they differ in `labels` ([P] each, which must outlive the rule).
  JoinRule join_rule(std::vector<const std::vector<uint32_t>*> labels) const;
  // Echoes of paths, of which those that are `joined` go into the one before.
  std::vector<Echoes> joined(std::vector<Echoes> of_paths, std::span<const uint8_t> joined) const;

  // Takes back echoes that are done with, for their memory.
  void recycle(std::span<Echoes> echoes) const;

  // Lengths [channel, P] in m and amplitudes [channel, P] in sqrt(W) at one time. Raises Cancelled when the job is.
  void evaluate(std::span<const int64_t> paths, double time, std::vector<double>& lengths,
                std::vector<std::complex<double>>& amplitudes, Job* job = nullptr) const;
  // The same amplitudes [view, channel, P] with the weights of launch cells that are looked at in other ways: wider ones are
  // those of fewer rays, sides of 0 switch the footprint filter off.
  void evaluate(std::span<const int64_t> paths, double time, std::span<const CellView> cells, std::vector<double>& lengths,
                std::vector<std::complex<double>>& amplitudes, Job* job = nullptr) const;

 private:
  // A level, and where what it says of some channels goes.
  struct Target;
  struct NeededOrder;
  size_t num_receivers() const { return radar_.receivers.size(); }
  std::vector<Echoes> take_echoes(size_t num_echoes, size_t num_channels, size_t num_nodes) const;
  std::vector<Echoes> at_nodes(std::span<const int64_t> paths, const NodeLevel& level, uint8_t* turned = nullptr) const;
  RadioConstants radio_of(const Target& target) const;
  void evaluate_at(std::span<const int64_t> paths, std::span<Target> targets) const;
  void raise_orders(const FrameNodes& nodes, const Echoes& echoes, std::vector<NeededOrder>& needed) const;
  FailedPath failed(int64_t path, int index, const NeededOrder& needed, bool turned) const;

  const Paths& paths_;
  const Radar& radar_;
  ReplaySettings settings_;
  RadioConstants radio_;
  Localiser localise_;
  NodeLevels levels_;
};

}  // namespace echopath
