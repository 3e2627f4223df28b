#pragma once
// Range-azimuth maps: received power by range and direction.
#include <optional>
#include <vector>

#include "echopath/base/job.h"
#include "echopath/radar/radar.h"
#include "echopath/spectrum/beam_kernel.h"
#include "echopath/spectrum/beamform.h"
#include "echopath/spectrum/range_doppler.h"

namespace echopath {

// What of the velocities a range-azimuth map shows.
struct VelocityChoice {
  std::optional<double> velocity;    // m/s, of the cells taken; none: all velocities
  Combine combine = Combine::kSum;   // of all velocities: their sum, or the largest of them
};

struct RangeAzimuth {
  std::vector<double> azimuth;     // [A] rad, ascending, left positive
  std::vector<double> range;       // [R] m
  std::vector<double> elevation;   // [E] rad, of the beams
  std::optional<double> velocity;  // m/s, of the cells; none: all velocities
  std::vector<double> power;       // [A, R] W, the largest over elevation
};

// Power that beams toward each azimuth pass at each range, the largest over the elevations. A point of any one velocity
// gives its received power, as in `beamform`, in each of the three kinds of maps:
//   the cells nearest to `velocity`. Noise is that of a cell.
//   the largest cell over all velocities. Noise is the largest of as many cells: ln(num_chirps) times their mean, about.
//   the sum of all velocities, divided by their number and by the window's noise bandwidth over the number of chirps:
//     the mean over chirps, weighted by the squared window. Points of several velocities add up. Noise of power P in one
//     sample of a range profile gives P / N for N elements (Bartlett without a window): no gain by the chirps.
// With all velocities the covariance for Capon is that of a range and its neighbours, over all velocities.
// Parallel over ranges; independent of threads. Raises as `beamform`; invalid_argument unless |velocity| is within
// half a cell of the map's axis.
RangeAzimuth range_azimuth(const RangeDoppler& map, const Radar& radar, const AngleGrid& angles,
                           const VelocityChoice& choice = {}, const BeamformOptions& options = {}, Job* job = nullptr);

}  // namespace echopath
