#pragma once
// Finds the antennas at the rim of an array.
#include <vector>

#include "echopath/radar/radar.h"

namespace echopath {

// Returns the indices, ascending, of the antennas that lie farthest along the principal axes of their positions and along
// the diagonals of the two longer ones: the two ends of a line, the corners of a rectangle, at most ten. There are none
// where all stand at one place.
std::vector<int> array_corners(const std::vector<Antenna>& antennas);

}  // namespace echopath
