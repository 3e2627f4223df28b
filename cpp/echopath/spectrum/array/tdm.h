#pragma once
// Transmitters that take turns see a moving target one slot after the other: the phase that its motion adds between
// slots looks like a direction until it is taken out.
#include <complex>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/radar/radar.h"
#include "echopath/spectrum/range_doppler.h"

namespace echopath {

// Returns e^{-j 2 pi f_D m Td} with f_D = 2 v / wavelength, [tx, V], which takes out the phase that a velocity v adds until
// slot m; 1 where the transmitters do not take turns.
std::vector<std::complex<double>> slot_phasors(const Radar& radar, const std::vector<double>& velocity);

// Returns the map with the phase between slots taken out, each cell by its velocity. A target between two cells keeps at
// most pi (M - 1) / (M Nc) of it, for M transmitters and Nc chirps.
// M slots divide the unambiguous velocity by M: v_max = wavelength / (4 M Td). For a target at v + 2 fold v_max, which
// appears at v, the phase is wrong by 2 pi fold m / M unless its `fold` is given; the velocities of the result are those
// assumed, v + 2 fold v_max.
// Raises invalid_argument unless the map is the radar's, has not been compensated before, and |fold| <= 1000.
RangeDoppler compensate_tdm(const RangeDoppler& map, const Radar& radar, int fold = 0, Job* job = nullptr);

// Raises invalid_argument unless the map's channels and axes are the radar's and its arrays fit each other.
void require_map_of(const RangeDoppler& map, const Radar& radar);

}  // namespace echopath
