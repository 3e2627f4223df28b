#pragma once
// Chains the transforms of nodes that hang below each other.
#include <vector>

#include "echopath/base/geometry.h"

namespace echopath {

// Returns world_from_node of `count` nodes, parents before their children: local(i) is the transform of a node into its
// parent, parent(i) the parent's place among the nodes, negative for the world.
template <class Local, class Parent>
std::vector<Transform> chained_transforms(size_t count, const Local& local, const Parent& parent) {
  std::vector<Transform> world;
  world.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    const int above = parent(i);
    const Transform in_parent = local(i);
    world.push_back(above < 0 ? in_parent : world[above] * in_parent);
  }
  return world;
}

}  // namespace echopath
