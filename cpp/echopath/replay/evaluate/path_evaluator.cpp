#include "echopath/replay/evaluate/path_evaluator.h"

#include "echopath/replay/evaluate/edge_echoes.h"
#include "echopath/replay/factors/lobe_factors.h"

namespace echopath {

void PathEvaluator::begin(const PathPreparer& preparer, const Radar& radar, const SheetPassages& sheets,
                          SpecularPoints specular, bool as_chains) {
  preparer_ = &preparer;
  sheets_ = &sheets;
  planner_.begin(preparer.paths(), preparer, specular, !as_chains && can_evaluate_single_bounces(radar));
}

std::vector<uint8_t> PathEvaluator::leave_out_dark(const PosedNodes& nodes, const FrameNodes& times,
                                                   const RadioConstants& radio, double limit) {
  std::vector<uint8_t> dark(indices_.size());
  shared_legs_.find_dark(*plan_, *preparer_, nodes, times, radio, limit, dark);
  left_.clear();
  for (size_t place = 0; place < dark.size(); ++place) {
    if (!dark[place]) left_.push_back(indices_[place]);
  }
  if (left_.size() == indices_.size()) return dark;
  shared_legs_.leave_out(*plan_, dark);
  planner_.leave_out(dark);
  indices_ = left_;
  return dark;
}

void PathEvaluator::evaluate(const PosedNodes& nodes, const RadioConstants& radio, const ChannelSpan& channels,
                             const Wanted& wanted) {
  shared_legs_(*plan_, *preparer_, nodes, radio, channels);
  single_bounces_(*plan_, *preparer_, nodes, radio, channels, wanted);
  evaluate_edges(*plan_, sheets_->sheets(), nodes, radio, channels, wanted.with_amplitudes);
  if (wanted.with_amplitudes) apply_lobes(*plan_, *preparer_, nodes, channels);
  if (!preparer_->paths().passes.empty()) sheets_->apply(indices_, nodes, channels, wanted.with_amplitudes);
  if (wanted.turned) shared_legs_.mark_turned(*plan_, wanted.turned);
  if (wanted.unfiltered) shared_legs_.mark_unfiltered(*plan_, radio, wanted.unfiltered);
}

}  // namespace echopath
