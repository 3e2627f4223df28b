#pragma once
// At which times of a frame its paths are to be checked, so that no period of a motion hides what becomes of them.
#include <vector>

#include "echopath/radar/radar.h"
#include "echopath/scene/scene.h"

namespace echopath {

inline constexpr int kBaseCheckTimes = 5;    // both ends and three places between, for whatever moves
inline constexpr int kMostCheckTimes = 256;  // for what turns faster than they follow, a warning is due

// The first of them are checked for everything, the others for meshes that need them: prefixes of a sequence by the golden
// ratio are spread evenly, and lie at no fraction of a frame or of a turn.
struct CheckTimes {
  std::vector<double> times;        // s
  int num_base = 0;                 // that everything needs
  std::vector<int> of_mesh;         // [meshes], how many of them a mesh needs
  std::vector<double> turn;         // [meshes] rad, how far it turns within the frame at most (Motion::turn_rate)
  std::vector<uint32_t> too_fast;   // IDs of meshes that would need more than there may be
};

// Both ends of the frame that starts at `start` (s) and, where something moves, places between: more for what turns far, by eight
// for each turn, and for what has breakpoints.
CheckTimes check_times(const Scene& scene, const Radar& radar, double start);

// Those that were asked for, for everything.
CheckTimes given_check_times(const Scene& scene, const Radar& radar, double start, std::vector<double> times);

}  // namespace echopath
