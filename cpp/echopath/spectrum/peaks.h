#pragma once
// From cells above their thresholds to echoes: local maxima, and where between the cells they lie.
#include <array>
#include <cstdint>
#include <vector>

#include "echopath/spectrum/cfar.h"

namespace echopath {

// Echoes of N cells, in their order.
struct Peaks {
  std::vector<std::array<int64_t, 2>> cells;  // [N] (velocity, range)
  std::vector<double> velocity_offset, range_offset;  // [N] cells, from the middle of the cell to the peak
  std::vector<double> velocity;  // [N] m/s, receding positive, within the axis, which is a circle
  std::vector<double> range;     // [N] m, where the map shows it: with the shift that velocity makes, f_c v / slope
  std::vector<double> power;     // [N] W, mean over channels, of the peak: what the cell lost to its offsets is put back
  std::vector<double> noise;     // [N] W, about the cell
};

// Local maxima among the cells found: not below any of the eight neighbours, and above those that come before. The
// offsets are exact for a tone, whatever window and zero padding: with u the field of a neighbour over that of the cell,
// in phase with the window's response, u(+1) - u(-1) is a known odd function of the offset, which is inverted. That
// is within 1e-6 cells. In noise, at 20 dB in the cell, the rms error is 0.06 cells for Hann.
// Real samples: no range offset in the first and the last range cell, whose neighbours are images.
// Parallel over cells; independent of threads. Raises invalid_argument unless both are of the radar's map.
Peaks find_peaks(const RangeDoppler& map, const Radar& radar, const CfarResult& found, Job* job = nullptr);

}  // namespace echopath
