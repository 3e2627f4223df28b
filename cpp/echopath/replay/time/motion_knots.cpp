#include "echopath/replay/time/motion_knots.h"

#include <algorithm>

#include "echopath/motion/looped_sequence.h"
#include "echopath/motion/skin.h"

namespace echopath {
namespace {

// Appends `times`, unless they stand at the end already: the parts of one body share their times.
void append(const std::vector<double>& times, std::vector<double>& all) {
  const auto count = static_cast<ptrdiff_t>(times.size());
  if (all.size() >= times.size() && std::equal(times.begin(), times.end(), all.end() - count)) return;
  all.insert(all.end(), times.begin(), times.end());
}

void append_knots(const Motion* motion, std::vector<double>& all) {
  if (const auto* keyframes = dynamic_cast<const KeyframeMotion*>(motion)) append(keyframes->times(), all);
}

void append_knots(const Deformation* deformation, const TimeSpan& during, std::vector<double>& all) {
  if (const auto* looped = dynamic_cast<const LoopedSequence*>(deformation)) append(looped->knots(during), all);
  else if (const auto* sequence = dynamic_cast<const VertexSequence*>(deformation)) append(sequence->times(), all);
  if (const auto* skin = dynamic_cast<const Skin*>(deformation)) {
    for (const Joint& joint : skin->joints()) append_knots(joint.motion.get(), all);
    append_knots(skin->shape().get(), during, all);
  }
}

std::vector<double> ascending(std::vector<double> times) {
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

}  // namespace

std::vector<double> motion_breakpoints(const Scene& scene, const Radar& radar, const TimeSpan& during) {
  std::vector<double> times = scene.breakpoints(during);
  if (radar.motion) append(radar.motion->breakpoints(during), times);
  return ascending(std::move(times));
}

std::vector<double> motion_knots(const Scene& scene, const Radar& radar, const TimeSpan& during) {
  std::vector<double> times = motion_breakpoints(scene, radar, during);
  append_knots(radar.motion.get(), times);
  for (int index = 0; index < static_cast<int>(scene.nodes().size()); ++index) {
    const Node& node = scene.nodes()[static_cast<size_t>(index)];
    if (!scene.takes_part(index)) continue;
    append_knots(node.motion.get(), times);
    append_knots(node.deformation.get(), during, times);
  }
  return ascending(std::move(times));
}

}  // namespace echopath
