#pragma once
// Transmitters that take turns see a moving target one slot after the other: the phase that its motion adds between
// slots looks like a direction until it is taken out.
#include <complex>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/radar/radar.h"
#include "echopath/spectrum/range_doppler.h"

namespace echopath {

// Returns by how much later than the first transmitter each sends, [tx] in s, the mean over the chirps; 0 where they do not
// take turns.
std::vector<double> slot_delays(const Radar& radar);

// Returns e^{-j 2 pi f_D t_m} with f_D = 2 v / wavelength, [tx, V], which takes out the phase that a velocity v adds in the
// delay t_m of transmitter m; 1 where the transmitters do not take turns.
std::vector<std::complex<double>> slot_phasors(const Radar& radar, const std::vector<double>& velocity);

// Returns 4 pi f_m / c, [tx] in rad/m, by which an echo turns with its range because transmitter m sends f_m above the first
// one, in the middle of the sweep; empty where all send alike, or where the steps of a transmitter change from chirp to
// chirp.
std::vector<double> carrier_turns(const Radar& radar);

// Returns e^{-j r 4 pi f_m / c}, [tx, R], which takes these phases out; empty where there are none.
std::vector<std::complex<double>> carrier_phasors(const Radar& radar, const std::vector<double>& range);

// Returns the map with the phase between slots taken out, each cell by its velocity and its range. A target between two
// cells keeps at most pi (M - 1) / (M Nc) of it, for M transmitters and Nc chirps.
// M slots divide the unambiguous velocity by M: v_max = wavelength / (4 M Td). For a target at v + 2 fold v_max, which
// appears at v, the phase is wrong by 2 pi fold m / M (slots as far apart as each other) unless its `fold` is given; the
// velocities of the result are those assumed, v + 2 fold v_max.
// Raises invalid_argument unless the map is the radar's, has not been compensated before, and |fold| <= 1000.
RangeDoppler compensate_tdm(const RangeDoppler& map, const Radar& radar, int fold = 0, Job* job = nullptr);

// Raises invalid_argument unless the map's axes are those of the radar's chirps.
void require_axes(const RangeDoppler& map, const Radar& radar);

// Raises invalid_argument unless the map's channels and axes are the radar's and its arrays fit each other.
void require_map_of(const RangeDoppler& map, const Radar& radar);

}  // namespace echopath
