#pragma once
// Tells by which polarisation a record tells the modes of sheets apart.
#include "echopath/record/paths.h"

namespace echopath {

// Returns the polarisation in the world by which the scalar model and the legs between hits tell modes apart: that of the
// first transmitter at the time of the trace.
Vec3 sheet_polarization(const Paths& paths);

}  // namespace echopath
