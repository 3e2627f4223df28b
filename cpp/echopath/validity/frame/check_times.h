#pragma once
// Chooses the times of a frame at which its paths are checked, so that no period of a motion hides what becomes of them.
#include <vector>

#include "echopath/radar/radar.h"
#include "echopath/scene/scene.h"

namespace echopath {

inline constexpr int kBaseCheckTimes = 5;   // both ends and three places between, for whatever moves
inline constexpr int kMaxCheckTimes = 256;  // a warning is due for what turns too fast for so many
inline constexpr double kChecksPerTurn = 8.0;

// Holds the times of a check. Everything is checked at the first of them, and meshes that need them at the others: prefixes
// of a sequence by the golden ratio are spread evenly, and lie at no fraction of a frame or of a turn.
struct CheckTimes {
  std::vector<double> times;       // s
  int num_base = 0;                // at which everything is checked
  std::vector<int> of_mesh;        // [meshes] how many of them a mesh needs
  std::vector<double> turn;        // [meshes] rad, how far it turns within the frame, seen by the radar (Motion::turn_rate)
  std::vector<uint32_t> too_fast;  // IDs of meshes that would need more than kMaxCheckTimes, by turns or breakpoints
  double turn_of_radar = 0.0;      // rad, its part of all turns
  bool is_radar_too_fast = false;  // its motion alone would need more than kMaxCheckTimes
};

// Returns the beginning of the frame that starts at `start` (s), and where something moves its end and times between: eight
// more for each turn of what turns far, and two more for each breakpoint.
CheckTimes check_times(const Scene& scene, const Radar& radar, double start);

// Returns the given times, at all of which everything is checked.
CheckTimes given_check_times(const Scene& scene, const Radar& radar, double start, std::vector<double> times);

}  // namespace echopath
