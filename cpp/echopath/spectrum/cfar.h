#pragma once
// Detection at a constant false-alarm rate (CFAR): which cells of a range-Doppler map stand out of the noise about them.
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "echopath/base/job.h"
#include "echopath/radar/radar.h"
#include "echopath/spectrum/cfar_factor.h"
#include "echopath/spectrum/range_doppler.h"

namespace echopath {

// Half widths in cells; none: guard cells of the window's main lobe, 4 training cells of velocity and 8 of range for each
// cell of an unpadded map, fewer where the map is small, none along an axis without room for them.
struct CfarOptions {
  CfarMethod method = CfarMethod::kCellAveraging;
  double false_alarm_rate = 1e-6;  // of one cell
  std::optional<int> guard_velocity, guard_range, training_velocity, training_range;
  double rank = 0.75;              // kOrderedStatistic: share of training cells that the statistic is not below
};

struct CfarResult {
  CfarDesign design;               // what the options came to
  CfarFactors factors;
  int64_t num_velocities = 0, num_ranges = 0;
  std::vector<double> power;       // [V, R] W, mean over channels
  std::vector<std::array<int64_t, 2>> cells;  // [D] (velocity, range) of the cells above their thresholds, ascending
  std::vector<double> noise;       // [D] W, mean power of the noise about each of them, as the training cells tell it
};

// Cells whose power, summed over all channels, exceeds what the training cells about them make of a false-alarm rate
// (Finn, Johnson 1968: cell averaging; Rohling 1983: ordered statistic). Velocity is a circle; at the ends of the range
// axis training cells are taken from the other side. Where a target fills training cells it raises the threshold of its
// neighbours: the ordered statistic minds less.
// Model: noise alike in all cells, independent between channels. The threshold is right for the correlation that window
// and zero padding make (cfar_factor.h). Real samples: not within the main lobe of range 0, where the image leaks.
// Cost per cell: CA as many additions as the window has rows, and log2 of its columns; OS about a quarter of its
// training cells, counted. Parallel over velocities; independent of threads.
// Cost of the thresholds, once for each design (the last 8 are kept): cubic in the number of cells of the window, counted
// without padding. CA, one core: 0.1 s for the defaults, 3 s for 12 x 24 training cells on each side; OS three to six times
// that.
// Raises invalid_argument naming the argument, also unless the map is the radar's and for windows of more than 2000 cells,
// counted without padding; Cancelled when the job is, within half a second.
CfarResult cfar(const RangeDoppler& map, const Radar& radar, const CfarOptions& options = {}, Job* job = nullptr);

// What the options come to for a map.
CfarDesign cfar_design(const RangeDoppler& map, const Radar& radar, const CfarOptions& options);

}  // namespace echopath
