#pragma once
// Lengths and amplitudes of blocks of paths at the nodes of a time grid: plans what the paths share, and evaluates it.
#include "echopath/replay/evaluate/direct_evaluation.h"

namespace echopath {

// Keeps its memory from block to block; for one thread at a time.
class PathEvaluator {
 public:
  using Wanted = DirectEvaluation::Wanted;
  // For blocks of this record, played back with `radar`, from now on. All must outlive its use. With SpecularPoints::kFermat
  // lengths, cosines, gains and spreading are those over the moved points, for each antenna at which a path begins; reflection
  // coefficients and launch cells stay those of the trace.
  void begin(const PathPreparer& preparer, const Radar& radar, SpecularPoints specular);
  // The paths that are evaluated next, which must outlive that.
  void plan(std::span<const int64_t> indices) { plan_ = &planner_(indices); }
  void evaluate(const PosedNodes& nodes, const RadioConstants& radio, const ChannelSpan& channels, const Wanted& wanted = {});
  size_t num_bytes() const { return chains_.num_bytes() + direct_.num_bytes(); }  // of its memory, nearly all

 private:
  ChainPlanner planner_;
  ChainEvaluation chains_;
  DirectEvaluation direct_;
  const PathPreparer* preparer_ = nullptr;
  const ChainPlan* plan_ = nullptr;
};

}  // namespace echopath
