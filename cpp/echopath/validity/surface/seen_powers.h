#pragma once
// Computes the power that antennas receive from each object at the times of a check, and how much of it comes from surface
// that the record lacks (new_surface.h): seen from the antennas of the trace and from those at the rim of the array.
#include <map>

#include "echopath/validity/surface/new_surface.h"
#include "echopath/validity/validity_objects.h"

namespace echopath {

// Holds the power of an object, summed over all times and antennas.
struct SeenPower {
  double seen = 0.0, fresh = 0.0;  // W: of all of it, and of its new surface
  double largest = 0.0;            // W, of the object at one time, from the antennas of the trace
};

// Returns the powers of objects by node index; there are none where nothing moves and there is no array. Adds the power of
// new surface that the antennas of the trace receive at the base times to `at_times`. Paths and radar are those of the
// check, which ends here. The result has the same bits for any number of threads. Raises Cancelled.
std::map<size_t, SeenPower> find_seen_powers(const Paths& paths, const Radar& radar, FrameCheck& check,
                                             ObjectsAtTimes& at_times, Job* job);

}  // namespace echopath
