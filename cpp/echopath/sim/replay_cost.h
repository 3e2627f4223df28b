#pragma once
// Estimates how long the computation of a signal will take.
#include "echopath/sim/stream/cube_pass.h"

namespace echopath {

// Returns about how many seconds all threads of this machine take to evaluate the moving paths exactly at every chirp or
// sample, to a factor of three; 0 where the settings interpolate in time, which is quick.
double exact_seconds(const Paths& paths, const Radar& radar, const CubeSettings& settings);

// Returns about how many seconds the further traces or renewals of a frame in several stretches take, to a factor of three;
// 0 where there are none, or where `validity` is still to say how many.
double keyframe_seconds(const Paths& paths, const KeyframeSettings& settings);

}  // namespace echopath
