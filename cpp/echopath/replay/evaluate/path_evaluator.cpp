#include "echopath/replay/evaluate/path_evaluator.h"

namespace echopath {

void PathEvaluator::begin(const Localiser& localise, const Radar& radar, SpecularPoints specular) {
  localise_ = &localise;
  planner_.begin(localise.paths(), localise, specular, can_evaluate_directly(radar));
}

void PathEvaluator::evaluate(const LevelView& level, const RadioConstants& radio, const ChannelSpan& channels, const Wanted& wanted) {
  chains_(*plan_, *localise_, level, radio, channels);
  direct_(*plan_, *localise_, level, radio, channels, wanted);
  if (wanted.turned) chains_.mark_turned(*plan_, wanted.turned);
}

}  // namespace echopath
