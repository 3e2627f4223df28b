#include "echopath/replay/posed/instant.h"

#include "echopath/scene/smooth.h"

namespace echopath {
namespace {

std::vector<PosedAntenna> posed(const std::vector<Antenna>& antennas, const Transform& world_from_radar, const Vec3& origin) {
  std::vector<PosedAntenna> out;
  for (const Antenna& antenna : antennas) {
    const Mat3 world_from_antenna = world_from_radar.linear() * antenna.orientation.toRotationMatrix();
    out.push_back({world_from_radar * antenna.position - origin,
                   (world_from_radar.linear() * (antenna.orientation * Vec3::UnitX())).normalized(),
                   world_from_antenna * antenna.polarization, &antenna.pattern, world_from_antenna.transpose()});
  }
  return out;
}

}  // namespace

Instant::Instant(const Scene& scene, const Radar& radar, const std::vector<SurfacePatch>& patches, const Vec3& origin,
                 double time) {
  const Transform world_from_radar = radar.world_from_radar(time);
  transmitters = posed(radar.transmitters, world_from_radar, origin);
  receivers = posed(radar.receivers, world_from_radar, origin);
  const std::vector<Transform> world_from_mesh = world_from_meshes(scene, time);
  for (uint32_t id = 0; id < world_from_mesh.size(); ++id) {
    add_mesh(scene.node_of(id), patches[id], world_from_mesh[id], origin, time);
  }
}

void Instant::add_mesh(const Node& node, const SurfacePatch& patch, const Transform& world_from_mesh, const Vec3& origin,
                       double time) {
  rotation_.push_back(world_from_mesh.linear());
  normal_matrix_.push_back(cofactor_matrix(world_from_mesh.linear()));
  translation_.push_back(world_from_mesh.translation() - origin);
  std::vector<Vec3>& vertices = deformed_vertices_.emplace_back();
  std::vector<Vec3>& normals = deformed_normals_.emplace_back();
  if (!node.deformation) return;
  node.deformation->at(time, patch.original_vertex, vertices);
  if (node.smooth) normals = vertex_normals(vertices, patch.triangles);
}

}  // namespace echopath
