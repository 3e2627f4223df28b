#pragma once
// Fills echoes that hold in each chirp their values and the derivatives of their delays.
#include "echopath/replay/time/frame_nodes.h"

namespace echopath {

// Fills the rows of `echoes` (derivative_sampling) that hold derivatives of the delays: 1/s, 1/s^2, 1/s^3 times the unit of
// `delay`, from the polynomial `from` over `delay` [from.num_rows, num_echoes]. It leaves the amplitudes as they are; those
// of derivatives must be zero. The bits of an echo do not depend on the others.
void fill_derivatives(const TimeSampling& from, const double* delay, Echoes& echoes);

}  // namespace echopath
