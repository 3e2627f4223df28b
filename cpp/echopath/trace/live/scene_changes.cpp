#include "echopath/trace/live/scene_changes.h"

namespace echopath {
namespace {

bool is_same_place(const Node& a, const Node& b) {
  return a.motion == b.motion && a.placement.matrix() == b.placement.matrix();
}

bool is_same_surface(const Node& a, const Node& b) {
  return a.mesh == b.mesh && a.deformation == b.deformation && a.material == b.material && a.smooth == b.smooth;
}

// Returns the index of the node of that name, or -1. Most nodes stand where they stood.
int index_in(const Scene& scene, const std::string& name, size_t likely) {
  if (likely < scene.nodes().size() && scene.nodes()[likely].name == name) return static_cast<int>(likely);
  return scene.find(name).value_or(-1);
}

std::vector<int> indices_before(const Scene& before, const Scene& after) {
  std::vector<int> indices;
  for (size_t i = 0; i < after.nodes().size(); ++i) indices.push_back(index_in(before, after.nodes()[i].name, i));
  return indices;
}

// Tells by node of `after` whether it or a node above has other places than before; parents come before their children.
std::vector<bool> moved_nodes(const Scene& before, const Scene& after, const std::vector<int>& index_before) {
  std::vector<bool> has_moved(after.nodes().size());
  for (size_t i = 0; i < has_moved.size(); ++i) {
    const Node& node = after.nodes()[i];
    const int known = index_before[i];
    has_moved[i] = (node.parent >= 0 && has_moved[node.parent]) || known < 0 || !is_same_place(before.nodes()[known], node);
  }
  return has_moved;
}

std::vector<uint32_t> mesh_of_node(const Scene& scene) {
  std::vector<uint32_t> ids(scene.nodes().size(), kNoMesh);
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) ids[scene.meshes()[id].node] = id;
  return ids;
}

}  // namespace

void SceneChanges::mark(uint32_t id) {
  of_after[id] = true;
  if (id_before[id] != kNoMesh) of_before[id_before[id]] = true;
}

SceneChanges changes_between(const Scene& before, const Scene& after, bool time_moved) {
  const std::vector<int> index_before = indices_before(before, after);
  const std::vector<bool> has_moved = moved_nodes(before, after, index_before);
  const std::vector<uint32_t> ids = mesh_of_node(before);
  SceneChanges changes;
  changes.id_after.assign(before.meshes().size(), kNoMesh);
  changes.of_before.assign(before.meshes().size(), true);  // unless one of after is the same
  uint32_t next = 0;
  for (uint32_t id = 0; id < after.meshes().size(); ++id) {
    const auto node = static_cast<size_t>(after.meshes()[id].node);
    const int known = index_before[node];
    const uint32_t is = known < 0 ? kNoMesh : ids[known];
    changes.id_before.push_back(is);
    changes.of_after.push_back(true);
    if (is == kNoMesh) continue;
    changes.id_after[is] = id;
    changes.has_same_ids = changes.has_same_ids && is == id;
    changes.has_same_order = changes.has_same_order && is >= next;
    next = is + 1;
    changes.of_after[id] =
        has_moved[node] || !is_same_surface(before.node_of(is), after.node_of(id)) || (time_moved && after.is_moving(id));
    changes.of_before[is] = changes.of_after[id];
  }
  return changes;
}

std::vector<Box> boxes_of(const EmbreeScene& geometry, uint32_t num_meshes) {
  std::vector<Box> boxes;
  for (uint32_t id = 0; id < num_meshes; ++id) {
    Box box = geometry.box(id);
    if (!box.isEmpty()) {
      const Vec3 margin = Vec3::Constant(16.0 * geometry.lift());
      box.extend(box.min() - margin).extend(box.max() + margin);
    }
    boxes.push_back(box);
  }
  return boxes;
}

}  // namespace echopath
