#pragma once
// Evaluates paths of one point each at all nodes, eight points of a mesh at a time: they share only the antennas as seen
// from the mesh.
#include <vector>

#include "echopath/replay/evaluate/shared_legs.h"
#include "echopath/replay/kernels/single_bounce_kernels.h"

namespace echopath {

// Evaluates the single bounces of a plan. It keeps its memory from block to block and serves one thread at a time.
class SingleBounceEvaluation {
 public:
  static constexpr size_t kSlots = SingleBounceSlots::kSlots, kOfNode = SingleBouncesToEvaluate::kNumRows * kSlots;
  struct Wanted {
    uint8_t* turned = nullptr;     // [P] or null, see SharedLegEvaluation::mark_turned
    double* unfiltered = nullptr;  // [P] or null, likewise mark_unfiltered
    bool with_amplitudes = true;   // else they are not evaluated
  };
  // Writes the single bounces of the plan, for antennas that can_evaluate_single_bounces.
  void operator()(const SharedLegPlan& plan, const PathPreparer& preparer, const PosedNodes& nodes,
                  const RadioConstants& radio, const ChannelSpan& channels, const Wanted& wanted);
  size_t num_bytes() const { return (out_.capacity() + legs_.capacity()) * sizeof(double); }  // of its memory, nearly all

 private:
  using Points = std::span<const SharedLegPlan::SingleBounce* const>;
  void sort_by_mesh(const SharedLegPlan& plan);
  void begin(const PathPreparer& preparer, const PosedNodes& nodes, const RadioConstants& radio,
             const ChannelSpan& channels);
  Points next_points(size_t first) const;
  void enter_mesh(uint32_t mesh_id, const PathPreparer& preparer, const PosedNodes& nodes);
  void put_all(Points points, const ChannelSpan& channels, const Wanted& wanted) const;
  void set_antennas(const PosedNodes& nodes);
  bool is_monostatic(const PosedNodes& nodes) const;
  void see_antennas(uint32_t mesh_id, const PathPreparer& preparer, const PosedNodes& nodes);
  void see_axes(uint32_t mesh_id, const PathPreparer& preparer, const PosedNodes& nodes);
  void set_mesh(uint32_t mesh_id, const PathPreparer& preparer);
  void set_slots(Points points, const PathPreparer& preparer);
  void set_weights(const SharedLegPlan::SingleBounce& point, size_t slot, const Paths& paths);
  void put(Points points, const ChannelNodes& to, const double* values) const;
  void put_joined(Points points, const ChannelNodes& to, const double* values) const;
  void mark_turned(Points points, uint8_t* turned) const;
  void mark_unfiltered(Points points, double* unfiltered) const;

  std::vector<const SharedLegPlan::SingleBounce*> sorted_;  // by mesh, each in the order of the plan
  std::vector<size_t> first_of_mesh_;
  std::vector<SingleBounceAntenna> antennas_[2];  // of transmitters, of receivers
  NodeRows seen_[2];                              // [antenna] as seen from the mesh in hand
  NodeRows axes_;                                 // of the world, as seen from the mesh; where polarisations need them
  double scale_[SingleBounceSlots::kNumKinds];    // of the amplitudes of a kind (RadioConstants)
  SingleBounceTrace trace_;
  SingleBounceSlots slots_;
  SingleBouncesToEvaluate work_;
  std::vector<double> legs_, out_;
  SingleBounceSlots::Row turned_, unfiltered_;
};

// Returns whether the gains of all antennas are whole powers of cosines.
bool can_evaluate_single_bounces(const Radar& radar);

}  // namespace echopath
