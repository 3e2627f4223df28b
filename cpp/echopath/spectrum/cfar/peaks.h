#pragma once
// Finds echoes among the cells above their thresholds: local maxima, and where between the cells they lie.
#include <array>
#include <complex>
#include <cstdint>
#include <vector>

#include "echopath/spectrum/cfar/cfar.h"

namespace echopath {

// Holds the echoes of N cells, in the order of the cells.
struct Peaks {
  std::vector<std::array<int64_t, 2>> cells;          // [N] (velocity, range)
  std::vector<double> velocity_offset, range_offset;  // [N] cells, from the middle of the cell to the peak
  std::vector<double> velocity;                       // [N] m/s, receding positive, wrapped into the axis
  std::vector<double> range;  // [N] m, as in the map: with the shift f_c v / slope that velocity makes
  std::vector<double> power;  // [N] W, mean over channels or of the beam, with the loss by the offsets put back
  std::vector<double> noise;  // [N] W, about the cell
  // [N, tx, rx] with beams: the field of the beam in the cell is the sum of weight times value over the channels.
  std::vector<std::complex<double>> beam_weights;
};

// Finds the local maxima among the cells above their thresholds: a cell is not below any of its eight neighbours, and above
// those that come before. The offsets are exact for a tone, whatever window and zero padding: with u the field of a
// neighbour over that of the cell, in phase with the window's response, u(+1) - u(-1) is a known odd function of the offset,
// which is inverted to within 1e-6 cells. In noise, at 20 dB in the cell, the rms error is 0.06 cells for Hann.
// Real samples have no range offset in the first and the last range cell, whose neighbours are images.
// Where cells were tested in beams, all that is of the beam of each cell, in its neighbours, too.
// Runs in parallel over cells; the result does not depend on the threads. Raises invalid_argument unless both are of the
// radar's map.
Peaks find_peaks(const RangeDoppler& map, const Radar& radar, const CfarResult& found, Job* job = nullptr);

}  // namespace echopath
