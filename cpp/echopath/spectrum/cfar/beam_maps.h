#pragma once
// Forms maps of power of all beams of an array from a map of its channels.
#include <cstdint>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/radar/radar.h"
#include "echopath/spectrum/angle/beam_source.h"
#include "echopath/spectrum/range_doppler.h"

namespace echopath {

// Holds the beams toward all directions (covering_directions.h). It keeps a reference to the map, and forms some beams at a
// time: those of a large array would not fit into memory together.
class BeamMaps {
 public:
  // Raises as `covering_directions` and `beamform`.
  BeamMaps(const RangeDoppler& map, const Radar& radar);

  int64_t num_beams() const { return std::ssize(directions_); }
  const Vec3& direction(int64_t beam) const { return directions_[beam]; }
  // Returns how many maps 64 MiB hold, one at least.
  int64_t num_together() const;

  // Returns the power [V, R] in W of `count` beams from `first` on, as `beamform` has it. It advances the job by the
  // velocities of a map.
  std::vector<std::vector<double>> powers(int64_t first, int64_t count, Job* job) const;

 private:
  const BeamSource source_;
  const std::vector<Vec3> directions_;
  const int64_t num_velocities_, num_ranges_;
};

}  // namespace echopath
