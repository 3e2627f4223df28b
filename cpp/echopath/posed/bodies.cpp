#include "echopath/posed/bodies.h"

#include "echopath/scene/meshes_by_node.h"

namespace echopath {

Box box_of(const PosedScene& pose, uint32_t mesh_id) {
  Box box;
  const Mat3& linear = pose.linear(mesh_id);
  const Vec3& translation = pose.world_translation(mesh_id);
  for (const Vec3& vertex : pose.local_vertices(mesh_id)) box.extend(Vec3(linear * vertex + translation));
  return box;
}

std::vector<Body> bodies_of(const Scene& scene, const PosedScene& pose) {
  MeshesByNode by_object;
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) by_object.add(scene.meshes()[id].object, id);
  std::vector<Body> bodies;
  for (const NodeMeshes& object : by_object.found()) {
    Body& body = bodies.emplace_back(Body{object.node, object.mesh_ids, {}});
    for (const uint32_t id : object.mesh_ids) body.box.extend(box_of(pose, id));
  }
  return bodies;
}

}  // namespace echopath
