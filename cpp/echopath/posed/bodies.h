#pragma once
// Groups the meshes of a scene by the bodies that they make up.
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "echopath/posed/posed_scene.h"

namespace echopath {

// Describes a child of the scene's root with all that is below it.
struct Body {
  int node = 0;  // index into Scene::nodes()
  std::vector<uint32_t> meshes;
  Box box;  // m, along the world's axes
};

// Returns the box of a mesh in m, along the world's axes.
Box box_of(const PosedScene& pose, uint32_t mesh_id);

// Returns all bodies that take part and have meshes, in the order of their first meshes. `pose` has all vertices of `scene`.
std::vector<Body> bodies_of(const Scene& scene, const PosedScene& pose);

}  // namespace echopath
