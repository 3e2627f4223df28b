#pragma once
// Lists the objects of a scene and finds the ball that holds one.
#include <functional>
#include <vector>

#include "echopath/scene/meshes_by_node.h"
#include "echopath/scene/scene.h"

namespace echopath {

struct Sphere {
  Vec3 centre = Vec3::Zero();
  double radius = 0.0;  // m

  bool holds(const Vec3& point) const { return (centre - point).norm() <= radius; }
};

// An object is a child of the scene's root with the meshes below it that are not flagged mirrors; it has at least one.
using SceneObject = NodeMeshes;

// Returns the objects in the order of their first mesh.
std::vector<SceneObject> objects_of(const Scene& scene);
// Returns how many these are, without a list of each one's meshes.
int64_t count_objects(const Scene& scene);

// Returns what an object consists of, in the order of their first mesh: the mesh of its own node, and what is below each
// child of that node. Its parts may have parts in turn; that of a node without children is the object itself.
std::vector<SceneObject> parts_of(const Scene& scene, const SceneObject& object);

// Returns the vertices of a mesh in the axes of the caller.
using VerticesOf = std::function<const std::vector<Vec3>&(uint32_t mesh_id)>;

// Returns a sphere about the centre of the box of the vertices that holds them all.
Sphere bounding_sphere(const VerticesOf& vertices_of, const std::vector<uint32_t>& mesh_ids);

}  // namespace echopath
