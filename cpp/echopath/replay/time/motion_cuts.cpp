#include "echopath/replay/time/motion_cuts.h"

#include <algorithm>
#include <iterator>

#include "echopath/motion/looped_sequence.h"
#include "echopath/motion/skin.h"

namespace echopath {
namespace {

std::vector<double> united(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> all;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(all));
  return all;
}

// Collects the cuts of some motions.
class CutsWithin {
 public:
  explicit CutsWithin(const TimeSpan& frame) : frame_(frame) {}

  void add(const Motion* motion) {
    append(motion->breakpoints(frame_), cuts_.breakpoints);
    if (const auto* keyframes = dynamic_cast<const KeyframeMotion*>(motion)) append(keyframes->times(), cuts_.knots);
  }

  void add(const Deformation* deformation) {
    append(deformation->breakpoints(frame_), cuts_.breakpoints);
    if (const auto* looped = dynamic_cast<const LoopedSequence*>(deformation)) append(looped->knots(frame_), cuts_.knots);
    else if (const auto* sequence = dynamic_cast<const VertexSequence*>(deformation)) append(sequence->times(), cuts_.knots);
    if (const auto* skin = dynamic_cast<const Skin*>(deformation)) {
      for (const Joint& joint : skin->joints()) {
        if (joint.motion) add(joint.motion.get());
      }
      if (skin->shape()) add(skin->shape().get());
    }
  }

  Cuts take() {
    make_ascending(cuts_.breakpoints);
    make_ascending(cuts_.knots);
    cuts_.knots = united(cuts_.breakpoints, cuts_.knots);
    return std::move(cuts_);
  }

 private:
  // `times` are ascending.
  void append(const std::vector<double>& times, std::vector<double>& all) const {
    const auto begin = std::ranges::upper_bound(times, frame_.begin);
    all.insert(all.end(), begin, std::lower_bound(begin, times.end(), frame_.end));
  }

  static void make_ascending(std::vector<double>& times) {
    std::ranges::sort(times);
    times.erase(std::unique(times.begin(), times.end()), times.end());
  }

  TimeSpan frame_;
  Cuts cuts_;
};

}  // namespace

MotionCuts::MotionCuts(const Scene& scene, const Radar& radar, const TimeSpan& frame) {
  CutsWithin of_radar(frame);
  if (radar.is_moving()) of_radar.add(radar.motion.get());
  index_of(of_radar.take());
  const auto joined_with = [&](uint32_t above, const auto& own) {
    if (!moves(own)) return above;
    CutsWithin cuts(frame);
    cuts.add(own.get());
    return join(above, index_of(cuts.take()));
  };
  std::vector<uint32_t> of_node;  // of its motion and those above it
  for (int index = 0; index < std::ssize(scene.nodes()); ++index) {
    const Node& node = scene.nodes()[index];
    const uint32_t above = node.parent < 0 ? kOfRadar : of_node[node.parent];
    of_node.push_back(scene.takes_part(index) ? joined_with(above, node.motion) : kOfRadar);
  }
  for (const SceneMesh& mesh : scene.meshes()) {
    const auto node = static_cast<size_t>(mesh.node);
    of_mesh_.push_back(joined_with(of_node[node], scene.nodes()[node].deformation));
  }
}

// Motions without cuts get those of the radar.
uint32_t MotionCuts::index_of(Cuts cuts) {
  if (!sets_.empty()) {
    const Cuts& of_radar = sets_[kOfRadar];
    cuts = {united(of_radar.breakpoints, cuts.breakpoints), united(of_radar.knots, cuts.knots)};
  }
  const auto [found, is_new] = index_.try_emplace(cuts, static_cast<uint32_t>(sets_.size()));
  if (is_new) sets_.push_back(std::move(cuts));
  return found->second;
}

uint32_t MotionCuts::join(uint32_t a, uint32_t b) {
  const auto [less, more] = in_order(a, b);
  if (less == kOfRadar || less == more) return more;
  const auto found = joined_.find({less, more});
  if (found != joined_.end()) return found->second;
  const Cuts &one = sets_[less], &other = sets_[more];
  const uint32_t index = index_of({united(one.breakpoints, other.breakpoints), united(one.knots, other.knots)});
  return joined_[{less, more}] = index;
}

uint32_t MotionCuts::joined(uint32_t a, uint32_t b) const {
  const auto [less, more] = in_order(a, b);
  return less == kOfRadar || less == more ? more : joined_.at({less, more});
}

}  // namespace echopath
