#pragma once
// Gathers meshes of a scene by the objects, or the parts of objects, that they are of.
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace echopath {

struct NodeMeshes {
  int node = 0;  // index into Scene::nodes()
  std::vector<uint32_t> mesh_ids;
};

// Gathers meshes by a node above them, in the order of their first meshes.
class MeshesByNode {
 public:
  void add(int node, uint32_t mesh_id) {
    const auto [entry, is_new] = place_.try_emplace(node, found_.size());
    if (is_new) found_.push_back({node, {}});
    found_[entry->second].mesh_ids.push_back(mesh_id);
  }

  const std::vector<NodeMeshes>& found() const { return found_; }

 private:
  std::vector<NodeMeshes> found_;
  std::unordered_map<int, size_t> place_;  // in found_, by node
};

}  // namespace echopath
