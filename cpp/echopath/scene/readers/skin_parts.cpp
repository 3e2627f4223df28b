#include "echopath/scene/readers/skin_parts.h"

#include <utility>

#include "echopath/base/errors.h"

namespace echopath {

std::vector<NamedMesh> parts_by_joint(const MeshPtr& mesh, const Skin& skin) {
  require(skin.num_vertices() == mesh->num_input_vertices(), "skin",
          "must have the " + std::to_string(mesh->num_input_vertices()) + " vertices the mesh was made from",
          skin.num_vertices());
  std::vector<Triangle> originals = mesh->triangles();
  for (Triangle& triangle : originals) {
    for (uint32_t& vertex : triangle) vertex = mesh->original_vertex()[vertex];
  }
  const std::vector<uint32_t> joint_of_triangle = skin.dominant_joint(originals);
  std::vector<std::vector<uint32_t>> triangles(skin.joints().size());
  for (uint32_t t = 0; t < joint_of_triangle.size(); ++t) triangles[joint_of_triangle[t]].push_back(t);

  std::vector<NamedMesh> parts;
  for (size_t joint = 0; joint < triangles.size(); ++joint) {
    if (triangles[joint].empty()) continue;
    parts.push_back({skin.joints()[joint].name, Mesh::part(mesh, std::move(triangles[joint]))});
  }
  return parts;
}

}  // namespace echopath
