#include "echopath/scene/scene_edges.h"

#include <memory>
#include <vector>

#include "echopath/base/memory/recent_results.h"
#include "echopath/scene/edges/moving_groups.h"
#include "echopath/scene/mesh/mesh_name.h"
#include "echopath/scene/seams.h"

namespace echopath {
namespace {

// Names a mesh whose edges make echoes, and where it stands among those that move alike; no mesh for another one.
struct Place {
  MeshName mesh;
  int group = 0;
  Eigen::Matrix4d place = Eigen::Matrix4d::Identity();

  bool operator==(const Place& other) const = default;
};

std::vector<Place> names_and_places(const Scene& scene) {
  std::vector<Place> places(scene.meshes().size());
  const MovingGroups groups(scene);
  for (uint32_t id = 0; id < places.size(); ++id) {
    if (!has_echoing_edges(scene, id)) continue;
    const auto [group, place] = groups.place_of(id);
    places[id] = {MeshName(scene.node_of(id).mesh), group, place.matrix()};
  }
  return places;
}

constexpr size_t kMostScenes = 4;

// Seams of the last scenes are kept, because each stage of a frame asks for them and they take long to find: they depend
// only on the meshes and on their places relative to each other.
std::shared_ptr<const SeamedEdges> seamed_edges(const Scene& scene) {
  using Recent = RecentResults<std::vector<Place>, std::shared_ptr<const SeamedEdges>>;
  static Recent& known = *new Recent(kMostScenes);  // never destroyed: threads may outlive what is static
  return known.get(names_and_places(scene), [&] { return std::make_shared<const SeamedEdges>(scene); });
}

}  // namespace

bool has_echoing_edges(const Scene& scene, uint32_t mesh_id) {
  const Node& node = scene.node_of(mesh_id);
  const bool is_like_conductor = node.material->conductor || node.material->reflectivity.has_value();
  return is_like_conductor && !node.material->mirror && !node.deformation && !scene.may_stretch(mesh_id);
}

SceneEdges::SceneEdges(const Scene& scene) : edges_(scene.meshes().size()) {
  const std::shared_ptr<const SeamedEdges> seamed = seamed_edges(scene);
  own_ = seamed->edges;
  body_ = seamed->body;
  for (uint32_t id = 0; id < own_.size(); ++id) {
    if (seamed->is_changed[id]) edges_[id] = own_[id];
    else if (has_echoing_edges(scene, id)) edges_[id] = scene.node_of(id).mesh->sharp_edges();
  }
}

}  // namespace echopath
