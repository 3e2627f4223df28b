#pragma once
// Finds which meshes of a scene keep their places to each other at all times.
#include <utility>
#include <vector>

#include "echopath/scene/scene.h"

namespace echopath {

// Names groups by nodes: that which moves all of a group or, where siblings move alike, as the parts of a body do that were
// given one motion each, the first of them. What rests has the group -1. Must not outlive the scene.
class MovingGroups {
 public:
  explicit MovingGroups(const Scene& scene);
  // Returns the group of a mesh, and the place of the mesh in the frame of the group.
  std::pair<int, Transform> place_of(uint32_t mesh_id) const;

 private:
  const Scene& scene_;
  std::vector<int> first_;  // by node that moves what is below it: the first node of its group
};

}  // namespace echopath
