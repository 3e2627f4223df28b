#include "echopath/replay/instant.h"

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

Instant::Instant(const Scene& scene, const Radar& radar, const Vec3& origin, double time) : pose_(scene, time) {
  const Transform world_from_radar = radar.world_from_radar(time);
  transmitters = posed(radar.transmitters, world_from_radar, origin);
  receivers = posed(radar.receivers, world_from_radar, origin);
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) {
    const Transform& world_from_mesh = pose_.world_from_mesh(id);
    const Mat3 linear = world_from_mesh.linear();
    rotation_.push_back(linear);
    normal_matrix_.push_back(linear.inverse().transpose() * linear.determinant());
    const Node& node = scene.node_of(id);
    const bool bends = node.smooth && node.sequence;
    deformed_normals_.push_back(bends ? vertex_normals(pose_.local_vertices(id), node.mesh->triangles()) : std::vector<Vec3>());
    translation_.push_back(world_from_mesh.translation() - origin);
  }
}

}  // namespace echopath
