#pragma once
// Looks for new surface (new_surface.h) at each time of a check, from the antennas of the trace and from those at the rim of
// the array, and sums up what is seen by object.
#include <map>

#include "echopath/validity/surface/new_surface.h"
#include "echopath/validity/validity_objects.h"

namespace echopath {

// Holds the power of what is seen of an object, over the times and antennas of all looks.
struct SeenPower {
  double seen = 0.0, fresh = 0.0;  // W: everything, and what is new
  double largest = 0.0;            // W, of what one look sees from the antennas of the trace
};

// Returns what is seen by object (node index); nothing where nothing moves and there is no array. Adds what the antennas of
// the trace see of new surface at the base times to `at_times`. Paths and radar are those of the check. The result has the
// same bits for any number of threads. Raises Cancelled.
std::map<size_t, SeenPower> find_seen_powers(const Paths& paths, const Radar& radar, const FrameCheck& check,
                                             ObjectsAtTimes& at_times, Job* job);

}  // namespace echopath
