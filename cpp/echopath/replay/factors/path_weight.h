#pragma once
// Gives the weight of a path as its amplitude takes it.
#include <complex>

#include "echopath/record/paths.h"

namespace echopath {

// Returns the factor of a path that neither motion nor antennas change: what the trace recorded. All amplitudes of replay
// are made of it, so that a factor of whole paths stands here: it knows the hits of the path, their number and their events,
// its flags, and the settings of the trace (`paths.frame`). The call is made once a path, not for each time.
inline std::complex<double> weight_of(const Paths& paths, size_t path) { return std::complex<double>(paths.weight[path]); }

}  // namespace echopath
