#pragma once
// Range-azimuth maps: received power by range and direction.
#include <optional>
#include <vector>

#include "echopath/base/job.h"
#include "echopath/radar/radar.h"
#include "echopath/spectrum/beamform.h"
#include "echopath/spectrum/range_doppler.h"

namespace echopath {

struct RangeAzimuth {
  std::vector<double> azimuth;     // [A] rad, ascending, left positive
  std::vector<double> range;       // [R] m
  std::vector<double> elevation;   // [E] rad, of the beams
  std::optional<double> velocity;  // m/s, of the cells; none: all velocities together
  std::vector<double> power;       // [A, R] W, the largest over elevation
};

// Power that beams toward each azimuth pass at each range, the largest over the elevations: of all velocities together,
// or of the cells nearest to `velocity` in m/s.
//
// All velocities: the sum over the map's velocities, divided by their number and by the window's noise bandwidth over
// the number of chirps: a point of any one velocity gives its received power, as in `beamform`; points of several
// velocities add up. It is the mean over chirps, weighted by the squared window, so that noise of power P in one sample
// of a range profile gives P / N for N elements (Bartlett without a window): no gain over noise by the chirps.
// For Capon the covariance of a range averages all velocities, and those of the neighbouring ranges.
// Parallel over ranges; independent of threads. Raises as `beamform`; invalid_argument unless |velocity| is within
// half a cell of the map's axis.
RangeAzimuth range_azimuth(const RangeDoppler& map, const Radar& radar, const AngleGrid& angles,
                           std::optional<double> velocity = {}, const BeamformOptions& options = {}, Job* job = nullptr);

}  // namespace echopath
