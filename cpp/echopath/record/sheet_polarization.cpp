#include "echopath/record/sheet_polarization.h"

namespace echopath {

Vec3 sheet_polarization(const Paths& paths) {
  const Antenna& first = paths.radar.transmitters.front();
  const Transform world_from_radar = paths.radar.world_from_radar(paths.frame.trace_time);
  return (world_from_radar.linear() * (first.orientation * first.polarization)).normalized();
}

}  // namespace echopath
