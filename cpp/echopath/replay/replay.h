#pragma once
// Replay computes what the recorded paths look like at other times and to other antennas, without tracing.
//
// Material points (diffuse hits and the physical-optics hit) move with their triangles, exactly; hits on flagged mirrors are
// replayed by images, exactly; other specular hits stay where they were recorded (second-order error in the slide) or move
// with the point of reflection by one Newton step (specular_slide.h).
#include <algorithm>
#include <complex>
#include <cstdint>
#include <span>

#include "echopath/replay/evaluate/path_evaluator.h"
#include "echopath/replay/factors/radio_constants.h"
#include "echopath/replay/joined_echoes.h"
#include "echopath/replay/time/path_grids.h"

namespace echopath {

// Names transmitters of a radar, one after the other; without anything said, all of them.
struct SomeTransmitters {
  size_t first = 0, count = SIZE_MAX;
};

class Replayer {
 public:
  // Names a time, and where the values of the paths then are written, [P] each; null: they are not wanted.
  struct Moment {
    double time;                       // s
    double* lengths;                   // m
    std::complex<double>* amplitudes;  // sqrt(W)

    // Returns the moments whose values are rows of tables [T, P].
    static std::vector<Moment> in_rows(std::span<const double> times, size_t num_paths, double* lengths,
                                       std::complex<double>* amplitudes);
    // Copies `count` values of echoes from one place on to another; lengths stand there in place of delays.
    void take(const Echoes& echoes, size_t from, size_t count, size_t to) const {
      if (lengths) std::copy_n(echoes.delay.data() + from, count, lengths + to);
      if (amplitudes) std::copy_n(echoes.amplitude.data() + from, count, amplitudes + to);
    }
  };

  // The radar may differ from the one of the trace in its waveform, antennas and motion. Both must outlive the replayer.
  // Raises invalid_argument when a motion does not cover the frame.
  Replayer(const Paths& paths, const Radar& radar, const ReplaySettings& settings = {});

  int num_channels() const;
  const TimeGrids& grids() const { return grids_; }
  // Returns the rule by which each path gets its time grid. The replayer must outlive it. This poses grids for trial: as
  // with the other functions that are not const, no thread may use the replayer meanwhile.
  PathGrids path_grids();

  // Poses all meshes at the time of the trace, for still().
  void pose_still() { posed_.pose_still(); }
  // Returns the echoes of `paths` (indices), by channel [tx * num_rx + rx]; their groups are left empty. Neither the paths
  // nor the radar may move: they are evaluated once, at the time of the trace.
  std::vector<Echoes> still(std::span<const int64_t> paths, const SomeTransmitters& transmitters = {}) const;
  // Finds the amplitude of the strongest of some paths at the time of the trace, between the first antennas. From then on
  // interpolated() leaves out paths that it may.
  void find_strongest();
  // Poses at the nodes of a polynomial the meshes that some paths touch, unless all are posed there: interpolated(),
  // turning() and by_chirp() take only paths for which this was called, which they do not check.
  void pose_polynomial(GridIndex polynomial, std::span<const int64_t> paths);
  // Interpolates the echoes of `paths` by a polynomial (grids()). Two kinds of paths are left out and added to `unfollowed`,
  // in their order: those that the polynomial does not follow, because the last two Chebyshev coefficients of their length
  // or of their amplitude exceed the tolerance; and negligible ones, whose amplitudes stay so small in all channels
  // of these transmitters, throughout the frame (is_dark), that all of them together are below the rounding of the strongest
  // path of the record.
  std::vector<Echoes> interpolated(std::span<const int64_t> paths, GridIndex polynomial,
                                   std::vector<UnfollowedPath>& unfollowed, const SomeTransmitters& transmitters = {}) const;
  // Returns whether turning() may be asked for a path: it must have a launch cell, whose filter is what turns.
  bool can_turn(int64_t path) const;
  // Interpolates the logarithms of amplitudes by a polynomial that follows the lengths: it follows the steep or turning
  // phases of waves from curved surfaces, of which no polynomial of few nodes follows the amplitudes
  // (TimeSampling::Rows::kLogarithms). can_turn() must take all paths. Those whose logarithms it does not follow are left
  // out and added to `unfollowed`, in their order, with no more said than their index.
  std::vector<Echoes> turning(std::span<const int64_t> paths, GridIndex polynomial, std::vector<UnfollowedPath>& unfollowed,
                              const SomeTransmitters& transmitters = {}) const;
  // Poses meshes that some paths touch, as PartlyPosedGrid::with takes them, at all nodes of a grid of chirps or samples,
  // which both functions below take; the replayer must outlive it.
  PartlyPosedGrid pose_partly(const TimeGrid& grid) const { return posed_.pose_partly(grid); }
  std::vector<uint32_t> meshes_of(std::span<const int64_t> paths) const;  // mesh IDs, ascending
  // Evaluates the channels of one transmitter [rx] at the nodes of a SampleGrid, which has several nodes in each of its
  // chirps.
  std::vector<Echoes> exact(std::span<const int64_t> paths, const PosedGrid& samples) const;
  // Evaluates the channels of one transmitter [rx] at the nodes of a ChirpGrid, in the middle of each chirp, and takes
  // derivatives of the lengths from a polynomial, which must follow them. The result has num_rows_by_chirp() rows. It serves
  // paths whose amplitude no polynomial follows, because it has a root where a surface turns away. Paths that are `joined`
  // go into the echo of the path before them (JoinRule); where `joined` is empty, each path keeps its own echo.
  std::vector<Echoes> by_chirp(std::span<const int64_t> paths, GridIndex polynomial, const PosedGrid& chirps,
                               std::span<const uint8_t> joined = {}) const;
  int64_t num_rows_by_chirp() const;

  // Evaluates `paths` for antennas of which each may move by itself: radars [T] have them where they stand in the world at
  // `times` [T] (s), as many as the replayer's radar and with its patterns. Returns echoes by channel, delays in s and
  // amplitudes in sqrt(W), [T, P] each; their groups and their sampling are left empty.
  std::vector<Echoes> placed(std::span<const int64_t> paths, std::span<const double> times,
                             std::span<const Radar> radars) const;

  // Returns the rule that joins paths into one echo, unless they differ in `labels` ([P] each, which must outlive the rule).
  JoinRule join_rule(std::vector<const std::vector<uint32_t>*> labels) const;
  // Adds the echo of each path that is `joined` to the echo before it, and returns those that are left.
  std::vector<Echoes> joined(std::vector<Echoes> of_paths, std::span<const uint8_t> joined) const;

  // Takes back echoes that are no longer needed, so that their memory is used again.
  void recycle(std::span<Echoes> echoes) const;

  // Computes lengths and amplitudes of `paths` between the first antennas at some times, a few of which take little more
  // than one, as the kernels work on several nodes at once. Lengths have the same bits with other times beside them,
  // amplitudes are rounded in another way. Raises Cancelled when the job is cancelled.
  void evaluate(std::span<const int64_t> paths, std::span<const Moment> moments, Job* job = nullptr) const;
  // Computes lengths [channel, P] in m and amplitudes [channel, P] in sqrt(W) at one `time` (s). Raises Cancelled when the
  // job is cancelled.
  void evaluate(std::span<const int64_t> paths, double time, std::vector<double>& lengths,
                std::vector<std::complex<double>>& amplitudes, Job* job = nullptr) const;
  // Computes amplitudes [view, channel, P] for several views of the launch cells: wider cells give the weights of a launch
  // with fewer rays, and cells with sides of 0 switch the footprint filter off.
  void evaluate(std::span<const int64_t> paths, double time, std::span<const CellView> cells, std::vector<double>& lengths,
                std::vector<std::complex<double>>& amplitudes, Job* job = nullptr) const;

 private:
  // Holds posed nodes and where the values of some channels at these nodes are written.
  struct Target;
  void evaluate_together(std::span<const int64_t> paths, std::span<const Moment> moments, Job* job) const;
  size_t num_receivers() const { return radar_.receivers.size(); }
  std::vector<Echoes> take_echoes(size_t num_echoes, size_t num_channels, size_t num_nodes) const;
  std::vector<Echoes> take_echoes_of(const PosedGrid& grid, const SomeTransmitters& transmitters, size_t num_echoes) const;
  using Wanted = PathEvaluator::Wanted;
  std::vector<Echoes> at_nodes(std::span<const int64_t> paths, const PosedGrid& grid, const SomeTransmitters& transmitters,
                               const Wanted& wanted) const;
  RadioConstants radio_of(const Target& target) const;
  std::unique_ptr<PathEvaluator> take_evaluator(bool as_chains = false) const;
  void evaluate_at(std::span<const int64_t> paths, std::span<Target> targets, bool as_chains = false) const;
  void evaluate_planned(PathEvaluator& evaluator, size_t first, std::span<Target> targets) const;
  void attenuate_all(size_t num_paths, std::span<const Target> targets) const;
  double negligible_amplitude() const;
  std::vector<Echoes> not_dark(std::span<const int64_t> paths, const PosedGrid& grid, const SomeTransmitters& transmitters,
                               const Wanted& wanted, std::vector<uint8_t>& dark) const;
  void raise_orders(const FrameNodes& nodes, const Echoes& echoes, std::span<const double> unfiltered,
                    std::vector<UnfollowedPath>& needed) const;
  void evaluate_turning(std::span<const int64_t> paths, const PosedGrid& grid, size_t first_channel,
                        std::span<Echoes> channels, std::span<std::vector<double>> turns) const;
  std::vector<uint8_t> negligible_ones(const FrameNodes& nodes, std::span<const Echoes> channels) const;

  const Paths& paths_;
  const Radar& radar_;
  ReplaySettings settings_;
  double strongest_ = 0.0;  // sqrt(W); 0: not looked for
  RadioConstants radio_;
  PathPreparer preparer_;
  SheetPassages sheets_;
  TimeGrids grids_;
  PosedGrids posed_;
};

}  // namespace echopath
