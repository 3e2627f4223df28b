#include "echopath/trace/live/scene_changes.h"

namespace echopath {
namespace {

bool is_same_place(const Node& a, const Node& b) {
  return a.motion == b.motion && a.placement.matrix() == b.placement.matrix();
}

bool is_same_surface(const Node& a, const Node& b) {
  return a.mesh == b.mesh && a.deformation == b.deformation && a.material == b.material && a.smooth == b.smooth;
}

}  // namespace

bool has_same_tree(const Scene& before, const Scene& after) {
  if (before.nodes().size() != after.nodes().size() || before.meshes().size() != after.meshes().size()) return false;
  for (size_t i = 0; i < before.nodes().size(); ++i) {
    const Node &a = before.nodes()[i], &b = after.nodes()[i];
    const bool is_same = a.parent == b.parent && !a.mesh == !b.mesh && a.name == b.name &&
                         before.takes_part(static_cast<int>(i)) == after.takes_part(static_cast<int>(i));
    if (!is_same) return false;
  }
  return true;
}

ChangedMeshes changed_meshes(const Scene& before, const Scene& after, bool time_moved) {
  std::vector<bool> has_moved(after.nodes().size());  // by node: it or a node above; parents come before their children
  for (size_t i = 0; i < has_moved.size(); ++i) {
    const Node& node = after.nodes()[i];
    const bool above = node.parent >= 0 && has_moved[static_cast<size_t>(node.parent)];
    has_moved[i] = above || !is_same_place(before.nodes()[i], node);
  }
  ChangedMeshes changed(after.meshes().size());
  for (uint32_t id = 0; id < changed.size(); ++id) {
    const auto node = static_cast<size_t>(after.meshes()[id].node);
    changed[id] = has_moved[node] || !is_same_surface(before.nodes()[node], after.nodes()[node]) ||
                  (time_moved && after.is_moving(id));
  }
  return changed;
}

std::vector<Eigen::AlignedBox3d> boxes_of(const EmbreeScene& geometry, uint32_t num_meshes) {
  std::vector<Eigen::AlignedBox3d> boxes;
  for (uint32_t id = 0; id < num_meshes; ++id) {
    Eigen::AlignedBox3d box = geometry.box(id);
    if (!box.isEmpty()) {
      const Vec3 margin = Vec3::Constant(16.0 * geometry.lift());
      box.extend(box.min() - margin).extend(box.max() + margin);
    }
    boxes.push_back(box);
  }
  return boxes;
}

}  // namespace echopath
