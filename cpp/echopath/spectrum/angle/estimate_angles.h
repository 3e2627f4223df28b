#pragma once
// Estimates where the echoes of chosen range-Doppler cells come from: the step from detections to points in space.
#include <cstdint>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/radar/radar.h"
#include "echopath/spectrum/angle/beamform.h"
#include "echopath/spectrum/range_doppler.h"

namespace echopath {

struct EstimateOptions {
  BeamformOptions beams;
  int max_peaks = 1;            // per cell, 1 to 64
  double peak_range_db = 10.0;  // 0 to 200 dB below the strongest peak of a cell, within which others are kept
  // The velocity may be v + 2 k v_max for |k| <= folds; the k with the strongest peak is taken, since TDM slots tell them
  // apart. It is less than half the number of transmitters, and 0 where these do not take turns.
  int folds = 0;
  // These are the velocities v, m/s, of the echoes in the cells [N], which may lie between those of the map; empty: those of
  // the cells. Compensation goes by them.
  std::vector<double> velocity;
  // These are the ranges of the echoes in the cells [N], m, as the map shows them, which may lie between those of the map;
  // empty: those of the cells. Phases of carriers that transmitters have of their own (tdm.h) go by them, less what the
  // velocity adds to the range that is shown.
  std::vector<double> range;

  void validate(int num_slots) const;
};

struct AngleEstimates {
  std::vector<int64_t> cell;                                       // [N] index into the cells given, ascending
  std::vector<double> range, velocity, azimuth, elevation, power;  // [N] m, m/s, rad, rad, W
  std::vector<Vec3> points;                                        // [N] m, in the radar's frame
};

// Finds the directions of the strongest peaks of beam power in each cell, strongest first. Paraboloids through the power of
// beams about a peak refine it beyond the grid; angles stay within the grid. Tops of the grid that lead to one peak, as on a
// beam that lies aslant, count once. A cell without power has no peak. A point is at its cell's range from the middle of the
// mean transmitter and the mean receiver.
// An array without vertical extent cannot tell elevations apart: give it one elevation.
// Runs in parallel over cells; the result does not depend on the number of threads. Raises as `beamform`.
inline constexpr double kSearchStep = kPi;  // largest_step of default axes for a search: the array sets the step
AngleEstimates estimate_angles(const RangeDoppler& map, const Radar& radar, const std::vector<Cell>& cells,
                               const AngleGrid& angles, const EstimateOptions& options = {}, Job* job = nullptr);

}  // namespace echopath
