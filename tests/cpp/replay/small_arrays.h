#pragma once
// What several tests of replay look at: a small array of antennas, and all paths of a record.
#include <cstdint>
#include <numeric>
#include <vector>

#include "cpp/support/scenes.h"
#include "echopath/record/paths.h"

namespace echopath::testing {

// Two transmitters and two receivers, 64 chirps.
inline Radar two_by_two() {
  Radar radar = plain_radar(Vec3::Zero(), Vec3(0, 0.01, 0));
  radar.waveform.num_chirps = 64;
  radar.transmitters.push_back(antenna_at(Vec3(0, 0.02, 0)));
  radar.receivers.push_back(antenna_at(Vec3(0, 0.03, 0)));
  return radar;
}

// Returns the indices of all paths, in their order.
inline std::vector<int64_t> all_of(const Paths& paths) {
  std::vector<int64_t> indices(static_cast<size_t>(paths.num_paths()));
  std::iota(indices.begin(), indices.end(), 0);
  return indices;
}

}  // namespace echopath::testing
