#pragma once
// Detects at a constant false-alarm rate (CFAR): finds the cells of a range-Doppler map that exceed the noise about them.
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/radar/radar.h"
#include "echopath/spectrum/cfar_factor/cfar_factor.h"
#include "echopath/spectrum/range_doppler.h"

namespace echopath {

// Half widths are in cells. By default guard cells cover the window's main lobe, and there are 4 training cells of velocity
// and 8 of range for each cell of an unpadded map, fewer where the map is small, none along an axis without room for them.
struct CfarOptions {
  CfarMethod method = CfarMethod::kCellAveraging;
  double false_alarm_rate = 1e-6;  // of each cell
  std::optional<int> guard_velocity, guard_range, training_velocity, training_range;
  double rank = 0.75;  // kOrderedStatistic: share of the training cells up to the statistic
  // Tests each cell in beams toward all directions (covering_directions.h), instead of the sum of its channels.
  bool beams = false;
  // [R] mean power of the noise at each range, in any unit, as the filters of a receiver shape it; empty: alike at all.
  std::vector<double> noise_shape = {};
};

struct CfarResult {
  CfarDesign design;  // resolved from the options
  CfarFactors factors;
  int64_t num_velocities = 0, num_ranges = 0;
  std::vector<double> power;                  // [V, R] W, mean over channels; with beams that of the strongest
  std::vector<std::array<int64_t, 2>> cells;  // [D] (velocity, range) of the cells above their thresholds, ascending
  std::vector<double> noise;                  // [D] W, mean noise power about each cell, from the training cells
  int64_t num_beams = 0;                      // in which each cell was tested, 0: its channels were summed
  std::vector<Vec3> beams;                    // [D] with beams: direction of the strongest that is above its threshold
};

// Finds the cells whose power, summed over all channels, exceeds the threshold that their training cells give for a
// false-alarm rate (Finn, Johnson 1968: cell averaging; Rohling 1983: ordered statistic; Hansen, Sawyers 1980: greatest of;
// Trunk 1978: smallest of). The velocity axis wraps around; at the ends of the range axis training cells are taken from the
// other side. A target within the training cells of its neighbours raises their thresholds, for the ordered statistic less,
// for the smallest of two halves not where it is in one of them alone; the greatest of them has fewer false alarms where
// clutter begins.
// Model: noise is independent between channels and alike in all cells, or has the noise shape, by which the power of each
// cell is divided before it is compared with others. The threshold allows for the correlation that window and zero padding
// make (cfar_factor.h). For real samples it does not hold within the main lobe of range 0, where the image leaks.
// With beams, each is a map of one channel, tested at the false-alarm rate over the number of beams: an echo is held against
// the noise of its own direction, 10 log10(channels) dB lower than that of a channel, and echoes of other directions do not
// hide it. The rate of a cell is then at most the one asked for, and less since beams overlap: up to a fifth for filled
// arrays, by half for sparse rectangles. Time: elements x beams products for each cell, and a CFAR for each beam.
// Cost per cell: CA takes as many additions as the window has rows, and log2 of its columns, GO and SO twice that; OS counts
// about a quarter of its training cells. Runs in parallel over velocities; the result does not depend on the number of
// threads. The thresholds are computed once for each design (the last 8 are kept), at a cost that is cubic in the number of
// cells of the window, counted without padding. CA takes 0.1 s on one core for the defaults and 3 s for 12 x 24 training
// cells on each side; the others three to nine times that. Raises invalid_argument naming the argument, also when the map is
// not the radar's and for windows of more than 2000 cells, counted without padding; raises Cancelled within half a second
// after the job is cancelled.
CfarResult cfar(const RangeDoppler& map, const Radar& radar, const CfarOptions& options = {}, Job* job = nullptr);

// Raises what `cfar` would with beams for an array of too many and for a false-alarm rate that is too small for them.
void check_beams(const Radar& radar, double false_alarm_rate);

// Returns the design that the options give for a map.
CfarDesign cfar_design(const RangeDoppler& map, const Radar& radar, const CfarOptions& options);

}  // namespace echopath
