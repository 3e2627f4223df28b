#pragma once
// Places the antennas of a radar at one time, in the axes of the world.
#include <vector>

#include "echopath/radar/radar.h"

namespace echopath {

struct PosedAntenna {
  Vec3 position;      // m, relative to the origin of the scene that it was posed with
  Vec3 boresight;     // unit
  Vec3 polarization;  // unit
  const AntennaPattern* pattern = nullptr;
  Mat3 antenna_from_world = Mat3::Identity();

  // Returns the gain toward a unit direction that leads away from the antenna, in world axes.
  AntennaGain toward(const Vec3& direction) const {
    return pattern->toward(boresight.dot(direction), [&] { return Vec3(antenna_from_world * direction); });
  }
};

// Returns a vector in an antenna's own axes as a unit vector in those of the world.
Vec3 in_world(const Antenna& antenna, const Vec3& own, const Transform& world_from_radar);

// Poses antennas, which must outlive the result; positions count from `origin` (m, world). Raises invalid_argument for an
// antenna out of the range of coordinates (base/range_of_coordinates.h).
std::vector<PosedAntenna> posed_antennas(const std::vector<Antenna>& antennas, const Transform& world_from_radar,
                                         const Vec3& origin);

}  // namespace echopath
