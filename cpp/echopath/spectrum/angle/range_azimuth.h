#pragma once
// Computes range-azimuth maps: received power by range and direction.
#include <array>
#include <optional>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/radar/radar.h"
#include "echopath/spectrum/angle/beam_kernel.h"
#include "echopath/spectrum/angle/beamform.h"
#include "echopath/spectrum/range_doppler.h"

namespace echopath {

// Selects the velocities that a range-azimuth map shows.
struct VelocityChoice {
  std::optional<double> velocity;                  // m/s, of the cells taken; none: all velocities
  Combine combine = Combine::kSum;                 // for all velocities: their sum, or the largest of them
  std::optional<std::array<double, 2>> gate = {};  // m/s, lowest and highest of "all velocities"; none: those of the map
};

struct RangeAzimuth {
  std::vector<double> azimuth;     // [A] rad, ascending, left positive
  std::vector<double> range;       // [R] m
  std::vector<double> elevation;   // [E] rad, of the beams
  std::optional<double> velocity;  // m/s, of the cells; none: all velocities
  std::vector<double> power;       // [A, R] W, the largest over elevation
};

// Computes the power that beams toward each azimuth pass at each range, the largest over the elevations. There are three
// kinds of maps; in each a point of any one velocity gives its received power, as in `beamform`:
//   With `velocity`, the map takes the nearest cells. Its noise is that of a cell.
//   With kPeak, it takes the largest cell over all velocities. Its noise is the largest of as many cells, about
//     ln(num_chirps) times their mean.
//   With kSum, it divides the sum of all velocities by their number and by the window's noise bandwidth over the number of
//     chirps: the mean over chirps, weighted by the squared window. Points of several velocities add up. Noise of power P
//     in one sample of a range profile gives P / N for N elements (Bartlett without a window): chirps give no gain.
// With all velocities Capon's covariance is that of a range and its neighbours, over all velocities. A gate leaves out the
// other velocities; noise of the sum falls by the share of the velocities that it takes.
// Runs in parallel over ranges; the result does not depend on the threads. Raises as `beamform`, and invalid_argument unless
// `velocity` is within half a cell of one of the map, where it has several, and for gates without a velocity of it or beside
// `velocity`.
RangeAzimuth range_azimuth(const RangeDoppler& map, const Radar& radar, const AngleGrid& angles,
                           const VelocityChoice& choice = {}, const BeamformOptions& options = {}, Job* job = nullptr);

}  // namespace echopath
