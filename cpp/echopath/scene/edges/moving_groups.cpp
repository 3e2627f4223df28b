#include "echopath/scene/edges/moving_groups.h"

#include <algorithm>
#include <array>
#include <map>
#include <tuple>

namespace echopath {
namespace {

using Numbers = std::array<double, 3>;

Numbers numbers_of(const Vec3& vector) { return {vector.x(), vector.y(), vector.z()}; }

// Names a motion of what is below one parent: nodes of equal names keep their places to each other. What may turn turns
// about its own origin, so that these have to be one.
struct MotionName {
  int parent;
  const Motion* motion;  // null of what goes straight on, which its velocities name
  Numbers velocity, angular_velocity, origin;

  explicit MotionName(const Node& node)
      : parent(node.parent), motion(node.motion.get()), velocity(), angular_velocity(), origin() {
    const auto* linear = dynamic_cast<const LinearMotion*>(motion);
    if (linear) {
      motion = nullptr;
      velocity = numbers_of(linear->velocity());
      angular_velocity = numbers_of(linear->angular_velocity());
    }
    if (!linear || !linear->angular_velocity().isZero(0.0)) origin = numbers_of(node.placement.translation());
  }
  bool operator<(const MotionName& other) const {
    const auto all = [](const MotionName& name) {
      return std::tie(name.parent, name.motion, name.velocity, name.angular_velocity, name.origin);
    };
    return all(*this) < all(other);
  }
};

// Returns the place of a node, whose motion may rest, in the frame of its parent.
Transform place_at_rest(const Node& node) {
  const TimeSpan span = node.motion ? node.motion->span() : TimeSpan{};
  return moved(node.placement, node.motion.get(), std::clamp(0.0, span.begin, span.end));
}

}  // namespace

MovingGroups::MovingGroups(const Scene& scene) : scene_(scene), first_(scene.nodes().size(), -1) {
  std::map<MotionName, int> known;
  for (int node = 0; node < std::ssize(first_); ++node) {
    const Node& at = scene.nodes()[node];
    if (moves(at.motion)) first_[node] = known.try_emplace(MotionName(at), node).first->second;
  }
}

std::pair<int, Transform> MovingGroups::place_of(uint32_t mesh_id) const {
  Transform place = Transform::Identity();
  for (int node = scene_.meshes()[mesh_id].node; node >= 0; node = scene_.nodes()[node].parent) {
    const Node& at = scene_.nodes()[node];
    if (!moves(at.motion)) {
      place = place_at_rest(at) * place;
      continue;
    }
    const Vec3 from_first = at.placement.translation() - scene_.nodes()[first_[node]].placement.translation();
    return {first_[node], Eigen::Translation3d(from_first) * Transform(at.placement.linear()) * place};  // motion.h: moved
  }
  return {-1, place};
}

}  // namespace echopath
