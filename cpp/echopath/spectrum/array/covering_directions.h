#pragma once
// Chooses directions whose beams together pass an echo from anywhere.
#include <vector>

#include "echopath/base/geometry.h"
#include "echopath/spectrum/array/virtual_array.h"

namespace echopath {

// Returns directions in steps of half the width of a beam, wavelength / (2 extent), over the cosines that an array tells
// apart: those within the unambiguous field of its grid, or without a grid all in front of its antennas. An echo loses at
// most 19 % of its power in the nearest beam along each axis of the array (1.8 dB over two). Of a grid, only the cosines
// along its axes are set, since its elements have no others. Raises invalid_argument for more than 131,072 beams, as of
// sparse arrays of a hundred wavelengths square.
std::vector<Vec3> covering_directions(const VirtualArray& array);

}  // namespace echopath
