#pragma once
// Paths written by hand over a small street, for tests that know the answer.
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "echopath/record/paths.h"
#include "echopath/scene/scene.h"

namespace echopath::testing {

struct HandMadeHit {
  uint32_t mesh_id;
  bool diffuse;
};
using HandMadePath = std::vector<HandMadeHit>;

enum StreetMesh : uint32_t { kWallLeft, kWallRight, kFloor, kTorso, kArmLeft, kArmRight, kNumStreetMeshes };

inline int add_node(Scene& scene, const std::string& name, int parent, bool has_mesh) {
  Node node;
  node.name = name;
  node.parent = parent;
  if (has_mesh) {
    const std::vector<Vec3> corners{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
    node.mesh = std::make_shared<const Mesh>(corners, std::vector<Triangle>{{0, 1, 2}});
    node.material = std::make_shared<const Material>(Material::metal());
  }
  return scene.add(std::move(node));
}

// Meshes in the order of StreetMesh.
inline std::shared_ptr<const Scene> make_street() {
  auto scene = std::make_shared<Scene>();
  const int street = add_node(*scene, "street", -1, false);
  add_node(*scene, "wall_left", street, true);
  add_node(*scene, "wall_right", street, true);
  add_node(*scene, "floor", street, true);
  const int pedestrian = add_node(*scene, "pedestrian", -1, false);
  add_node(*scene, "torso", pedestrian, true);
  const int arms = add_node(*scene, "arms", pedestrian, false);
  add_node(*scene, "left", arms, true);
  add_node(*scene, "right", arms, true);
  return scene;
}

// In the street.
inline Paths make_paths(const std::vector<HandMadePath>& hand_made) {
  Paths paths;
  auto hits = std::make_shared<std::vector<Hit>>();
  for (const HandMadePath& path : hand_made) {
    paths.offsets.push_back(static_cast<int64_t>(hits->size()));
    paths.num_bounces.push_back(static_cast<uint8_t>(path.size()));
    uint64_t diffuse = 0;
    for (size_t k = 0; k < path.size(); ++k) {
      diffuse |= static_cast<uint64_t>(path[k].diffuse) << k;
      hits->push_back({path[k].mesh_id, 0, 0.0f, 0.0f});
    }
    paths.diffuse.push_back(diffuse);
  }
  const size_t num_paths = hand_made.size();
  paths.weight.resize(num_paths);
  paths.stratum.resize(num_paths);
  paths.batch.resize(num_paths);
  paths.flags.resize(num_paths);
  paths.hits = std::move(hits);
  paths.scene = make_street();
  return paths;
}

// Paths of min_hits to max_hits hits on random meshes, each hit diffuse or not.
inline std::vector<HandMadePath> random_paths(size_t num_paths, uint32_t min_hits, uint32_t max_hits, uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<HandMadePath> paths(num_paths);
  for (HandMadePath& path : paths) {
    path.resize(min_hits + random() % (max_hits - min_hits + 1));
    for (HandMadeHit& hit : path) hit = {static_cast<uint32_t>(random() % kNumStreetMeshes), random() % 2 == 1};
  }
  return paths;
}

}  // namespace echopath::testing
