#pragma once
// Evaluates the paths of a block at all nodes from the legs that they share: a path costs a sum of lengths, a product of
// factors and, where it is coherent, the filter of its launch cell; an array of N x M channels costs N + M legs.
#include <array>

#include "echopath/replay/evaluate/shared_leg_tables.h"
#include "echopath/replay/factors/radio_constants.h"
#include "echopath/replay/factors/trace_cells.h"
#include "echopath/replay/time/frame_nodes.h"

namespace echopath {

// Says where the values of one channel are written, one row of echoes for each node: lengths (m) times `scale`, amplitudes
// in sqrt(W).
struct ChannelNodes {
  double* length;
  std::complex<double>* amplitude;
  size_t stride;      // between nodes
  size_t first_path;  // places count from there
  double scale;
  const uint32_t* echo_of = nullptr;  // [path] echo that the path is added to, which begins at 0; null: each has its own
  // The filter of a launch cell turns the phase of a coherent path (TurnApart). Where `turn` is not null, this angle (rad)
  // is written there, and the amplitude does not include it. Only coherent chains have it.
  double* turn = nullptr;

  size_t echo(size_t place) const { return echo_of ? echo_of[first_path + place] : first_path + place; }
  void set(size_t node, size_t place, double length_there, std::complex<double> amplitude_there) const {
    const size_t at = node * stride + echo(place);
    length[at] = scale * length_there;
    amplitude[at] = echo_of ? amplitude[at] + amplitude_there : amplitude_there;
  }
  // These change an echo that belongs to one path alone; `longer` is in m.
  template <class Factor>
  void scale_amplitude(size_t node, size_t place, Factor factor) const {
    amplitude[node * stride + echo(place)] *= factor;
  }
  void lengthen(size_t node, size_t place, double longer) const { length[node * stride + echo(place)] += scale * longer; }
};

// Names some channels [tx * num_rx + rx] for the antennas of the nodes, one after the other from `first` on.
struct ChannelSpan {
  size_t first;
  std::span<const ChannelNodes> nodes;
};

// Evaluates the chains and mirror paths of a plan. It keeps its memory from block to block and serves one thread at a time.
class SharedLegEvaluation {
 public:
  // Begins a new plan: forgets the posed points, legs and launch cells of the plan before. It must be called before the
  // first use of each plan.
  void begin_plan() {
    posed_at_ = nullptr;
    cells_.clear();
  }
  // Sets dark[place] to 1 for coherent chains whose amplitude stays below `limit` (sqrt(W)) for all antennas, at the nodes
  // and between them (stays_below, chebyshev_tails.h). It compares an upper bound of the amplitude, made of a bound of the
  // launch cell's filter over all antennas (filter_bound.h) and of their largest gains. Chains whose bound exceeds the limit
  // are not marked, even where their amplitude stays below it.
  void find_dark(const SharedLegPlan& plan, const PathPreparer& preparer, const PosedNodes& nodes, const FrameNodes& times,
                 const RadioConstants& radio, double limit, std::vector<uint8_t>& dark);
  // Removes what it holds of the paths whose places are marked ([P], 1 or 0). It must be called before the plan leaves out
  // these paths.
  void leave_out(const SharedLegPlan& plan, const std::vector<uint8_t>& places);
  // Writes the chains and mirror paths of the plan. Where the nodes are those of the last call, which must still be as they
  // were, only what depends on `radio` is evaluated again.
  void operator()(const SharedLegPlan& plan, const PathPreparer& preparer, const PosedNodes& nodes,
                  const RadioConstants& radio, const ChannelSpan& channels);
  // Reads the plan and the nodes of the last call: sets turned[place] to 1 where the surface at an end of the path turns its
  // other side to the first antenna there between the first and the last node, so that the amplitude of the path passes
  // through zero.
  void mark_turned(const SharedLegPlan& plan, uint8_t* turned) const;
  // Reads the plan and the nodes of the last call: sets unfiltered[place] to about the amplitude (sqrt(W)) that a coherent
  // path between the first antennas would have at the first node without the filter of its launch cell, at most that of a
  // mirror. The values of other paths are left as they are.
  void mark_unfiltered(const SharedLegPlan& plan, const RadioConstants& radio, double* unfiltered) const;
  size_t num_bytes() const { return tables_.num_bytes() + values_.num_bytes(); }  // of its memory, nearly all

 private:
  static constexpr size_t kTogether = 8;  // paths whose values are written side by side: a line of the cache for each node
  using Chains = std::span<const SharedLegPlan::ChainPath>;
  struct Ends {
    size_t start, end;  // antennas of both
  };
  struct MeasuredLeg {
    const LegTable& table;
    size_t leg;
    const double* rows() const { return table.rows.row(leg, 0); }
  };
  struct Around;
  void prepare(const SharedLegPlan& plan, const PathPreparer& preparer, const PosedNodes& nodes,
               const RadioConstants& radio);
  bool is_dark(const SharedLegPlan& plan, const SharedLegPlan::ChainPath& chain, const FrameNodes& times, double scale,
               double limit, const Around (&around)[2]);
  Ends ends_of(const SharedLegPlan::ChainPath& chain, size_t channel) const;
  PathToCombine path_of(const SharedLegPlan::ChainPath& chain, const Ends& ends, double scale, size_t slot);
  MeasuredLeg start_of(const SharedLegPlan::ChainPath& chain, size_t antenna) const;
  MeasuredLeg end_of(const SharedLegPlan::ChainPath& chain, size_t antenna) const;
  const double* inner_of(const SharedLegPlan::ChainPath& chain, size_t antenna) const;
  const double* image_of(const SharedLegPlan& plan, uint32_t leg, size_t antenna) const;
  void find_cells(const SharedLegPlan& plan, const TraceCells& cells);
  void place_cell(const SharedLegPlan& plan, size_t index, const TraceCells& cells, const PosedNodes& nodes, size_t slot);
  void evaluate_coherent(const SharedLegPlan& plan, const SharedLegPlan::ChainPath& chain, const Ends& ends, double scale,
                         size_t slot, bool has_turn_apart);
  void reflect_from_stretching(size_t slot, bool has_turn_apart);
  void evaluate_diffuse(const SharedLegPlan::ChainPath& chain, const Ends& ends, double scale, size_t slot);
  template <class Path>
  void put(std::span<const Path> paths, const ChannelNodes& to) const;  // from the first slots on
  ComplexOf<double> scaled_weight(const SharedLegPlan::ChainPath& chain, double scale) const;
  void turn(int64_t path, const MeasuredLeg& start, const MeasuredLeg& end, size_t slot);
  void polarize(int64_t path, const MeasuredLeg& start, const MeasuredLeg& end, size_t slot);
  void turn_phase(const MeasuredLeg& start, const MeasuredLeg& end, size_t slot);
  std::array<AxesAcross<double>, 2> axes_at_ends(const SharedLegPlan::MirrorPath& path) const;
  void evaluate_mirrors(const SharedLegPlan::MirrorPath& path, const PosedNodes& nodes, const ChannelSpan& channels,
                        double scale);
  bool turns(uint32_t leg) const;
  double size_of_weight(const SharedLegPlan::ChainPath& chain) const;
  double unfiltered(const SharedLegPlan::ChainPath& chain, const RadioConstants& radio) const;

  SharedLegTables tables_;
  const PosedNodes* posed_at_ = nullptr;          // of the tables; null: they hold nothing of the plan
  std::vector<PlacedCell> cells_;                 // [chain] where it is coherent and on a rigid mesh; empty: unknown
  NodeRows values_;                               // [slot], PathToCombine::Row
  NodeRows bounds_;                               // of one path, AmplitudeToBound::Row
  std::array<CoherentPath, kTogether> coherent_;  // [slot], the part that does not depend on the channel
  std::array<std::vector<PlacedCell>, kTogether> stretching_;  // [slot, node]; empty where the mesh is rigid
  NodeRows world_;                                             // a mesh whose frame is the world's, PointToPose::MeshRow
  LegTable mirror_legs_;  // of one channel: from the transmitter's image, from the receiver
  size_t num_receivers_ = 0;
  const SharedLegKernels* kernels_ = nullptr;
  const Paths* paths_ = nullptr;
};

}  // namespace echopath
