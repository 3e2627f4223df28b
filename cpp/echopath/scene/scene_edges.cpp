#include "echopath/scene/scene_edges.h"

#include <algorithm>
#include <memory>
#include <mutex>
#include <utility>

#include "echopath/scene/edges/moving_groups.h"
#include "echopath/scene/seams.h"

namespace echopath {
namespace {

// Remembers the seams of the last scenes, because each stage of a frame asks for them and they take long to find: they
// depend only on the meshes and on their places relative to each other.
class KnownSeams {
 public:
  std::shared_ptr<const SeamedEdges> of(const Scene& scene) {
    Key key = key_of(scene);
    {
      const std::lock_guard lock(mutex_);
      for (size_t i = 0; i < known_.size(); ++i) {
        if (!is_same(known_[i].first, key)) continue;
        std::rotate(known_.begin(), known_.begin() + static_cast<int64_t>(i), known_.begin() + static_cast<int64_t>(i) + 1);
        return known_.front().second;
      }
    }
    auto found = std::make_shared<const SeamedEdges>(scene);
    const std::lock_guard lock(mutex_);
    known_.emplace(known_.begin(), std::move(key), found);
    if (known_.size() > kMostKnown) known_.pop_back();
    return found;
  }

  static KnownSeams& of_process() {
    static KnownSeams& known = *new KnownSeams;  // never destroyed: threads may outlive what is static
    return known;
  }

 private:
  static constexpr size_t kMostKnown = 4;
  // Names a mesh whose edges make echoes, and where it stands; nothing for another one. What is named lives as long as the
  // name, so that no other mesh has its address.
  struct Place {
    std::weak_ptr<const Mesh> mesh;
    int group = 0;
    Transform place = Transform::Identity();
  };
  using Key = std::vector<Place>;

  static Key key_of(const Scene& scene) {
    Key key(scene.meshes().size());
    const MovingGroups groups(scene);
    for (uint32_t id = 0; id < key.size(); ++id) {
      if (!has_echoing_edges(scene, id)) continue;
      const auto [group, place] = groups.place_of(id);
      key[id] = {scene.node_of(id).mesh, group, place};
    }
    return key;
  }

  static bool is_same(const Key& a, const Key& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Place& one, const Place& other) {
      const bool is_one_mesh = !one.mesh.owner_before(other.mesh) && !other.mesh.owner_before(one.mesh);
      return is_one_mesh && one.group == other.group && one.place.matrix() == other.place.matrix();
    });
  }

  std::mutex mutex_;
  std::vector<std::pair<Key, std::shared_ptr<const SeamedEdges>>> known_;  // the last one first
};

}  // namespace

bool has_echoing_edges(const Scene& scene, uint32_t mesh_id) {
  const Node& node = scene.node_of(mesh_id);
  const bool is_like_conductor = node.material->conductor || node.material->reflectivity.has_value();
  return is_like_conductor && !node.material->mirror && !node.deformation && !scene.may_stretch(mesh_id);
}

SceneEdges::SceneEdges(const Scene& scene) : edges_(scene.meshes().size()) {
  const std::shared_ptr<const SeamedEdges> seamed = KnownSeams::of_process().of(scene);
  own_ = seamed->edges;
  body_ = seamed->body;
  for (uint32_t id = 0; id < own_.size(); ++id) {
    if (seamed->is_changed[id]) edges_[id] = own_[id];
    else if (has_echoing_edges(scene, id)) edges_[id] = scene.node_of(id).mesh->sharp_edges();
  }
}

}  // namespace echopath
