#pragma once
// Echoes that stand in each chirp with their values and the derivatives of their delays.
#include "echopath/replay/time/frame_nodes.h"

namespace echopath {

// Fills the nodes of `echoes` (derivative_sampling) that hold derivatives: of the delays (1/s, 1/s^2, 1/s^3 times their unit) those
// of the polynomial `from` over `delay` [from.num_nodes, num_echoes], of the amplitudes zero. The
// bits of an echo do not depend on the others.
void fill_derivatives(const TimeSampling& from, const double* delay, Echoes& echoes);

}  // namespace echopath
