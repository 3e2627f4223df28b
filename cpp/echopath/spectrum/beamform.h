#pragma once
// Beams of any array toward any directions: Bartlett (delay and sum) and Capon (minimum variance, distortionless).
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "echopath/base/job.h"
#include "echopath/radar/radar.h"
#include "echopath/spectrum/element_reader.h"
#include "echopath/spectrum/range_doppler.h"
#include "echopath/spectrum/steering.h"
#include "echopath/spectrum/window.h"

namespace echopath {

enum class BeamMethod { kBartlett, kCapon };

struct BeamformOptions {
  BeamMethod method = BeamMethod::kBartlett;
  Window window{WindowKind::kRect};  // kBartlett: over the rows and columns of a grid (steering.h)
  Overlaps overlaps = Overlaps::kAverage;
  bool compensate = true;            // the phase between TDM slots
  // kCapon: added to the diagonal of the covariance, relative to the mean power of the elements, 1e-9 to 1e3
  double diagonal_loading = 1e-2;
  // kCapon: cells on each side whose vectors are averaged in the covariance, 0 to 64; velocities go round
  int velocity_neighbours = 1, range_neighbours = 2;
  // kCapon: also average the covariance with that of the mirrored array, which tells apart two echoes of one phase
  // history; needs an array that is symmetric about its centre
  bool forward_backward = false;

  void validate() const;  // raises invalid_argument naming the field, the rule and the value
};

// (velocity, range) indices of a cell.
using Cell = std::array<int64_t, 2>;

struct BeamPower {
  std::vector<double> azimuth, elevation;  // [A], [E] rad
  std::vector<double> velocity, range;     // axes [V] m/s and [R] m; those of each cell, [N], where cells were given
  bool is_of_cells = false;
  std::vector<double> power;               // W, [E, A, V, R], of cells [E, A, N]
};

// Power that beams toward a grid of directions pass, in all cells of a map or in those given.
//
// Steering vectors are plane waves at the exact element positions and the wavelength at the centre frequency; patterns
// of the antennas are left aside. Both methods let an echo from the steered direction pass unchanged: a far point gives
// its received power in W, averaged over channels, at its own direction.
//   Bartlett: |sum_n w_n x_n e^{+j k x_n.u}|^2 with sum w_n = 1. Noise of power P in each channel's cell gives what it
//     gives in `angle_fft`: P / N for N elements without a window.
//   Capon: |w^H x|^2 with w = R^-1 a / (a^H R^-1 a) and R the mean of x x^H over the cell and its neighbours, loaded
//     (Capon 1969). One echo of power S in noise gives S + P / N at its direction, less elsewhere than Bartlett. It
//     resolves echoes closer than a beam when they differ in phase from snapshot to snapshot (other velocities or
//     ranges); its peaks are narrow: steps of the grid wider than them miss power, `estimate_angles` does not.
// Parallel over cells; independent of threads. Capon costs elements^3 + directions x elements^2 per cell.
// Raises invalid_argument when the map is not the radar's, on angles or options out of range, a window without a grid,
// and out_of_range on cells that the map does not have.
BeamPower beamform(const RangeDoppler& map, const Radar& radar, const AngleGrid& angles,
                   const BeamformOptions& options = {}, Job* job = nullptr);
BeamPower beamform(const RangeDoppler& map, const Radar& radar, const std::vector<Cell>& cells, const AngleGrid& angles,
                   const BeamformOptions& options = {}, Job* job = nullptr);

// Raises out_of_range unless all cells are in the map.
void require_cells_of(const RangeDoppler& map, const std::vector<Cell>& cells);

}  // namespace echopath
