#pragma once
// Measures how large the objects of a scene are.
#include <vector>

#include "echopath/posed/bodies.h"

namespace echopath {

// Describes the bounding box, along the world's axes, of a child of the scene's root with all that is below it.
struct ObjectSize {
  int node = 0;                          // index into Scene::nodes()
  double shortest = 0.0, longest = 0.0;  // sides, m
  bool is_closed = true;                 // all its meshes are (Mesh::is_closed)
};

// Returns the sizes of all bodies, in their order.
std::vector<ObjectSize> object_sizes(const Scene& scene, const std::vector<Body>& bodies);

}  // namespace echopath
