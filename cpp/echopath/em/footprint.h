#pragma once
// The footprint of a ray on a surface is described by the phase across the launch cell that the ray stands for.
#include <complex>

#include "echopath/em/footprint_formula.h"

namespace echopath {

using FootprintPhase = FootprintPhaseOf<double>;

// Returns the first-order footprint F = exp(-(g1^2 + g2^2) / 24), the Gaussian fit of a square cell's shape factor
// sinc(g1/2) sinc(g2/2) (ray-tube integration of Ling, Chou, Lee 1989). It lies in (0, 1].
double first_order_footprint(const FootprintPhase& phase);

// Returns the second-order footprint: the exact mean of e^{-j(g.x + x.h.x/2)} over a Gaussian of covariance spread^2
// (cells^2). |F| <= 1, and F -> 1 for small cells. `spread` is 0.6 for spherical Fibonacci points.
std::complex<double> second_order_footprint(const FootprintPhase& phase, double spread);

// Returns 3 F(s^2) - 3 F(2 s^2) + F(3 s^2), with F of the second order. Its response is flat near g = 0, so that phases that
// turn by a tenth of a cycle between rays lose less than 1e-3 where the Gaussian loses 8 %. |F| <= 7.
std::complex<double> edges_footprint(const FootprintPhase& phase, double spread);

// Returns the footprint of a flat surface behind flat mirrors: the product over both axes of 1 - (1 - exp(-g^2/8))^4. It is
// flatter near g = 0 than the Gaussian, so that plates lose nothing while phases turn by less than a quarter of a cycle
// between rays. It lies in [0, 1]. Higher powers are flatter still but let facets of a curved mesh alias: a sphere of facets
// errs by .10, .13, .19 dB with power 3, 4, 6 (2^14 rays).
double flat_top_footprint(const FootprintPhase& phase);

}  // namespace echopath
