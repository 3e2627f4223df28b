#pragma once
// Nodes of one triangle that tests put into scenes.
#include <string>

#include "echopath/scene/scene.h"

namespace echopath::testing {

inline MeshPtr triangle() {
  return std::make_shared<const Mesh>(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, std::vector<Triangle>{{0, 1, 2}});
}

inline Node group(const std::string& name, int parent = -1) {
  Node node;
  node.name = name;
  node.parent = parent;
  return node;
}

inline Node with_mesh(const std::string& name, int parent = -1, MeshPtr mesh = triangle()) {
  Node node = group(name, parent);
  node.mesh = std::move(mesh);
  node.material = std::make_shared<const Material>(Material::metal());
  return node;
}

}  // namespace echopath::testing
