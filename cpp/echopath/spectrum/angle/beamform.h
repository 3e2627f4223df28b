#pragma once
// Forms beams of any array toward any directions: Bartlett (delay and sum) and Capon (minimum variance, distortionless).
#include <array>
#include <cstdint>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/radar/radar.h"
#include "echopath/spectrum/array/element_reader.h"
#include "echopath/spectrum/array/steering.h"
#include "echopath/spectrum/range_doppler.h"
#include "echopath/spectrum/window.h"

namespace echopath {

enum class BeamMethod { kBartlett, kCapon };

struct BeamformOptions {
  BeamMethod method = BeamMethod::kBartlett;
  Window window{WindowKind::kRect};  // kBartlett: over the rows and columns of a grid (steering.h)
  Overlaps overlaps = Overlaps::kAverage;
  bool compensate = true;  // take out the phase between TDM slots
  // For kCapon, this times the mean power of the elements is added to the diagonal of the covariance; 1e-9 to 1e3.
  double diagonal_loading = 1e-2;
  // For kCapon, the covariance averages the snapshots of so many cells on each side, 0 to 64; the velocity axis wraps
  // around.
  int velocity_neighbours = 1, range_neighbours = 2;
  // For kCapon, the covariance is averaged with that of the mirrored array, too, which tells apart two echoes of one phase
  // history. This needs an array that is symmetric about its centre.
  bool forward_backward = false;

  void validate() const;  // raises invalid_argument naming the field, the rule and the value
};

// Holds the (velocity, range) indices of a cell.
using Cell = std::array<int64_t, 2>;

struct BeamPower {
  std::vector<double> azimuth, elevation;  // [A], [E] rad
  std::vector<double> velocity, range;     // axes [V] m/s and [R] m, or [N] those of the cells given
  bool is_of_cells = false;
  std::vector<double> power;  // W, [E, A, V, R], or [E, A, N] for cells
};

// Computes the power that beams toward a grid of directions pass, in all cells of a map or in those given.
//
// Steering vectors are plane waves at the exact element positions and the wavelength at the centre frequency; the patterns
// of the antennas are left aside. Both methods pass an echo from the steered direction unchanged: a far point gives its
// received power in W, averaged over channels, at its own direction.
//   Bartlett: |sum_n w_n x_n e^{+j k x_n.u}|^2 with sum w_n = 1. Noise of power P in each channel's cell gives what it
//     gives in `angle_fft`: P / N for N elements without a window.
//   Capon: |w^H x|^2 with w = R^-1 a / (a^H R^-1 a) and R the mean of x x^H over the cell and its neighbours, loaded
//     (Capon 1969). One echo of power S in noise gives S + P / N at its direction, and less elsewhere than Bartlett. It
//     resolves echoes closer than a beam when their phases differ from snapshot to snapshot (other velocities or ranges).
//     The phase between TDM slots is taken out of all these cells at the velocity of the one, whose echoes they share.
//     Its peaks are narrow: a grid with wider steps misses power, `estimate_angles` does not.
// Runs in parallel over cells; the result does not depend on the threads. Capon costs elements^3 + directions x elements^2
// per cell.
// Raises invalid_argument when the map is not the radar's, for angles or options out of range and for a window without a
// grid; raises out_of_range for cells that the map does not have.
BeamPower beamform(const RangeDoppler& map, const Radar& radar, const AngleGrid& angles, const BeamformOptions& options = {},
                   Job* job = nullptr);
BeamPower beamform(const RangeDoppler& map, const Radar& radar, const std::vector<Cell>& cells, const AngleGrid& angles,
                   const BeamformOptions& options = {}, Job* job = nullptr);

// Raises out_of_range unless all cells are in the map.
void require_cells_of(const RangeDoppler& map, const std::vector<Cell>& cells);

}  // namespace echopath
