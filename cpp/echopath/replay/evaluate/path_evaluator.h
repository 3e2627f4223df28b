#pragma once
// Evaluates lengths and amplitudes of blocks of paths at the nodes of a time grid: it plans what the paths share and
// evaluates that once.
#include "echopath/replay/evaluate/single_bounces.h"
#include "echopath/replay/factors/sheet_passages.h"

namespace echopath {

// Evaluates the paths of a block. It keeps its memory from block to block and serves one thread at a time.
class PathEvaluator {
 public:
  using Wanted = SingleBounceEvaluation::Wanted;
  // Sets the record whose blocks are evaluated from now on, the `radar` to which it is played back, and what its sheets do.
  // All must outlive this use. With SpecularPoints::kFermat, lengths, cosines, gains and spreading are those over the moved
  // points, for each antenna at which a path begins; reflection coefficients and launch cells stay those of the trace.
  // With `as_chains` paths of one point are evaluated as all others are, which alone can have their turns apart
  // (ChannelNodes).
  void begin(const PathPreparer& preparer, const Radar& radar, const SheetPassages& sheets, SpecularPoints specular,
             bool as_chains = false);
  // Plans the paths that are evaluated next; the indices must outlive that evaluation.
  void plan(std::span<const int64_t> indices) {
    plan_ = &planner_(indices);
    shared_legs_.begin_plan();
    indices_ = indices;
  }
  // Leaves those of the planned paths out whose amplitudes stay below `limit` (sqrt(W)) at the nodes of a polynomial and
  // between them, as far as this shows without evaluating them (SharedLegEvaluation::find_dark). Returns 1 for each of them,
  // else 0, [P]; values of the others are then written without gaps.
  std::vector<uint8_t> leave_out_dark(const PosedNodes& nodes, const FrameNodes& times, const RadioConstants& radio,
                                      double limit);
  void evaluate(const PosedNodes& nodes, const RadioConstants& radio, const ChannelSpan& channels,
                const Wanted& wanted = {});
  size_t num_bytes() const { return shared_legs_.num_bytes() + single_bounces_.num_bytes(); }  // of its memory, nearly all

 private:
  SharedLegPlanner planner_;
  SharedLegEvaluation shared_legs_;
  SingleBounceEvaluation single_bounces_;
  std::span<const int64_t> indices_;
  std::vector<int64_t> left_;  // of the indices
  const PathPreparer* preparer_ = nullptr;
  const SheetPassages* sheets_ = nullptr;
  const SharedLegPlan* plan_ = nullptr;
};

}  // namespace echopath
