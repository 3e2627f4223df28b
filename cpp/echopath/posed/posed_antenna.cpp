#include "echopath/posed/posed_antenna.h"

#include "echopath/base/range_of_coordinates.h"

namespace echopath {

Vec3 in_world(const Antenna& antenna, const Vec3& own, const Transform& world_from_radar) {
  return (world_from_radar.linear() * (antenna.orientation * own)).normalized();
}

std::vector<PosedAntenna> posed_antennas(const std::vector<Antenna>& antennas, const Transform& world_from_radar,
                                         const Vec3& origin) {
  std::vector<PosedAntenna> out;
  for (const Antenna& antenna : antennas) {
    require_in_range(world_from_radar * antenna.position, "radar", "antennas");
    const Mat3 world_from_antenna = world_from_radar.linear() * antenna.orientation.toRotationMatrix();
    out.push_back({world_from_radar * antenna.position - origin, in_world(antenna, Vec3::UnitX(), world_from_radar),
                   world_from_antenna * antenna.polarization, &antenna.pattern, world_from_antenna.transpose()});
  }
  return out;
}

}  // namespace echopath
