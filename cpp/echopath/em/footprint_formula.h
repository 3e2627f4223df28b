#pragma once
// Evaluates what a ray's footprint on a surface leaves of its echo, from the phase across the launch cell that the ray
// stands for. Math and Real are doubles or vectors of doubles, as in base/lanes/scalar_math.h.
#include "echopath/base/lanes/scalar_math.h"

namespace echopath {

enum class Footprint {
  kNone,         // every ray is a point: sums alias where the phase turns much from ray to ray
  kFirstOrder,   // linear phase across the cell
  kSecondOrder,  // quadratic phase: few rays suffice on curved surfaces
  kEdges,        // as kSecondOrder, but flatter: far fewer rays where a curved surface's edges make the echo
};

// Holds the phase of the path across the footprint, g.x + x.h.x / 2, with x in launch cells along the two footprint axes.
template <class Real>
struct FootprintPhaseOf {
  Real g1{}, g2{};           // rad per cell
  Real h11{}, h12{}, h22{};  // rad per cell^2
};

// Returns the first-order footprint F = exp(-(g1^2 + g2^2) / 24), the Gaussian fit of a square cell's shape factor
// sinc(g1/2) sinc(g2/2) (ray-tube integration of Ling, Chou, Lee 1989). It lies in (0, 1].
template <class Math, class Real>
ECHOPATH_INLINE Real first_order_footprint_of(const FootprintPhaseOf<Real>& phase) {
  return Math::exp((phase.g1 * phase.g1 + phase.g2 * phase.g2) * (-1.0 / 24.0));
}

// Holds a footprint as (root.re - j root.im) size e^{j turn}: behind curved bounces the turn can go through many cycles
// while a body moves by a few wavelengths, and all else changes slowly.
template <class Real>
struct TurningFootprint {
  ComplexOf<Real> root;
  Real size, turn;  // 1; rad
};

// Returns the second-order footprint: the exact mean of e^{-j(g.x + x.h.x/2)} over a Gaussian of covariance spread^2
// (cells^2). |F| <= 1, and F -> 1 for small cells. `spread` is 0.6 for spherical Fibonacci points.
template <class Math, class Real>
ECHOPATH_INLINE TurningFootprint<Real> turning_footprint_of(const FootprintPhaseOf<Real>& phase, double spread) {
  const double variance = spread * spread;
  const Real a11 = variance * phase.h11, a12 = variance * phase.h12, a22 = variance * phase.h22;
  const Real det = a11 * a22 - a12 * a12, trace = a11 + a22, rest = 1.0 - det;
  // D_F = det(I + jA) = (1 - det) + j trace. The larger part of its root is taken first, which cancels no digits; the real
  // part is the one that is not negative.
  const Real m = Math::root(rest * rest + trace * trace), inverse = 1.0 / m;
  const Real larger_part = Math::root(0.5 * (m + Math::magnitude(rest)));
  const Real other_part = trace / (2.0 * larger_part);
  const Real root_real = rest >= 0.0 ? larger_part : Math::magnitude(other_part);
  const Real root_imag = rest >= 0.0 ? other_part : Math::with_sign_of(larger_part, trace);
  const Real g_squared = phase.g1 * phase.g1 + phase.g2 * phase.g2;
  const Real form = a11 * phase.g1 * phase.g1 + 2.0 * a12 * phase.g1 * phase.g2 + a22 * phase.g2 * phase.g2;
  const Real turned = trace * g_squared - form;
  // The exponent is -variance/2 (g^2 + j turned) / D_F. Its real part is negative; behind several curved bounces cells can
  // be so large that rounding makes it positive.
  const Real scale = (-0.5 * variance) * inverse * inverse;
  const Real fading = Math::smaller(scale * (g_squared * rest + turned * trace), g_squared * 0.0);
  return {{root_real, root_imag}, Math::exp(fading) * inverse, scale * (turned * rest - g_squared * trace)};
}
template <class Math, class Real>
ECHOPATH_INLINE ComplexOf<Real> second_order_footprint_of(const FootprintPhaseOf<Real>& phase, double spread) {
  const TurningFootprint<Real> found = turning_footprint_of<Math>(phase, spread);
  const ComplexOf<Real> phasor = Math::cis(found.turn);
  const Real c = found.size * phasor.re, s = found.size * phasor.im;
  return {found.root.re * c + found.root.im * s, found.root.re * s - found.root.im * c};
}

// Returns 3 F(s^2) - 3 F(2 s^2) + F(3 s^2), with F of the second order. Its response is flat near g = 0, so that phases that
// turn by a tenth of a cycle between rays lose less than 1e-3 where the Gaussian loses 8 %. |F| <= 7.
template <class Math, class Real>
ECHOPATH_INLINE ComplexOf<Real> edges_footprint_of(const FootprintPhaseOf<Real>& phase, double spread) {
  constexpr double kRoot2 = 1.4142135623730951, kRoot3 = 1.7320508075688772;
  const ComplexOf<Real> once = second_order_footprint_of<Math>(phase, spread);
  const ComplexOf<Real> twice = second_order_footprint_of<Math>(phase, spread * kRoot2);
  const ComplexOf<Real> thrice = second_order_footprint_of<Math>(phase, spread * kRoot3);
  return {3.0 * (once.re - twice.re) + thrice.re, 3.0 * (once.im - twice.im) + thrice.im};
}

// Returns the footprint of a flat surface behind flat mirrors along one axis, 1 - (1 - exp(-g^2/8))^4; the whole one is the
// product over both. It is flatter near g = 0 than the Gaussian, so that plates lose nothing while phases turn by less than
// a quarter of a cycle between rays. It lies in [0, 1]. Higher powers are flatter still but let facets of a curved mesh
// alias: a sphere of facets errs by .10, .13, .19 dB with power 3, 4, 6 (2^14 rays).
template <class Math, class Real>
ECHOPATH_INLINE Real flat_top_of(Real g) {
  const Real loss = 1.0 - Math::exp(g * g * -0.125);  // its fourth power needs no more digits
  const Real square = loss * loss;
  return 1.0 - square * square;
}

// Bounds the waves that a launch cell may hold between its ray and those beside it, as shares of the amplitude without a
// filter.
template <class Real>
struct BetweenRays {
  Real points;  // waves of points of stationary phase
  Real edges;   // waves of the surface's edge, if that cuts the cell
};

// A ray of a coarse lattice misses a point of stationary phase by up to kReach cells. The filter then removes the wave of
// that point with all others, although the surface sends it: the integral of e^{jhx^2/2}, sqrt(2 pi/|h|) along each axis of
// h. Where the phase is not stationary along an axis, only an edge across it leaves a wave, of at most 2/|g|. Nothing is
// lost where the phase hardly turns across the cell, because such rays add up to the true field.
template <class Math, class Real>
ECHOPATH_INLINE BetweenRays<Real> between_rays_of(const FootprintPhaseOf<Real>& phase) {
  constexpr double kReach = 0.75, kTurn = 6.283185307179586, kTiny = 1e-300;
  const Real middle = 0.5 * (phase.h11 + phase.h22), half = 0.5 * (phase.h11 - phase.h22);
  const Real root = Math::root(half * half + phase.h12 * phase.h12);
  const Real first = Math::magnitude(middle + root) + kTiny, second = Math::magnitude(middle - root) + kTiny;
  // g^2 along the axis of the larger h: cosine and sine of twice its angle are half and h12 over the root.
  const Real all = phase.g1 * phase.g1 + phase.g2 * phase.g2, one = all * 0.0 + 1.0;
  const Real turned = half * (phase.g1 * phase.g1 - phase.g2 * phase.g2) + 2.0 * phase.h12 * phase.g1 * phase.g2;
  const Real along = 0.5 * (all + turned / (root + kTiny)), across = all - along;
  const auto is_at_first = along <= (kReach * kReach) * first * first,
             is_at_second = across <= (kReach * kReach) * second * second;
  const Real of_first = Math::smaller(one, kTurn / first), of_second = Math::smaller(one, kTurn / second);
  const Real slope = is_at_first ? across : is_at_second ? along : all;
  const Real of_edge = Math::smaller(one, 4.0 / (Math::magnitude(slope) + kTiny));
  const Real on_line = of_edge * (is_at_first ? of_first : is_at_second ? of_second : one);
  const Real lost = 1.0 - Math::exp(all * -0.125);
  const Real at_point = lost * Math::root(of_first * of_second), at_edge = lost * Math::root(on_line);
  const auto is_at_both = is_at_first & is_at_second;
  return {is_at_both ? at_point : one * 0.0, is_at_both ? one * 0.0 : at_edge};
}

}  // namespace echopath
