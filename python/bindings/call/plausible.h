#pragma once
// Looks for slips of units: what no radar can be raises ValueError, what is merely unlikely is warned of.
#include "echopath/radar/radar.h"

namespace echopath::bindings {

constexpr double kLowestFrequency = 1e6;    // Hz, of radars that look over the horizon
constexpr double kHighestFrequency = 1e14;  // Hz, of infrared light

void require_plausible(const ChirpSequence& waveform);
void require_plausible(const Radar& radar);
// rad: more than a turn is more likely degrees.
void warn_of_turns(double yaw);
// m/s; raises where it is not below the speed of light.
void require_below_light(double speed, const char* argument);

}  // namespace echopath::bindings
