#pragma once
// The filters of em/footprint.h for doubles and for vectors of doubles: Math as in base/scalar_math.h.
#include "echopath/base/scalar_math.h"

namespace echopath {

enum class Footprint {
  kNone,         // every ray is a point: sums alias where phases turn faster than rays are spaced
  kFirstOrder,   // linear phase across the cell
  kSecondOrder,  // quadratic phase: few rays suffice on curved surfaces
  kEdges,        // the same, flatter: far fewer rays where the edges of a curved surface make the echo
};

// Phase of the path across the footprint, g.x + x.h.x / 2, with x in units of launch cells along the two footprint axes.
template <class Real>
struct FootprintPhaseOf {
  Real g1{}, g2{};          // rad per cell
  Real h11{}, h12{}, h22{};  // rad per cell^2
};

template <class Math, class Real>
ECHOPATH_INLINE Real first_order_footprint_of(const FootprintPhaseOf<Real>& phase) {
  return Math::exp((phase.g1 * phase.g1 + phase.g2 * phase.g2) * (-1.0 / 24.0));
}

template <class Math, class Real>
ECHOPATH_INLINE ComplexOf<Real> second_order_footprint_of(const FootprintPhaseOf<Real>& phase, double spread) {
  const double variance = spread * spread;
  const Real a11 = variance * phase.h11, a12 = variance * phase.h12, a22 = variance * phase.h22;
  const Real det = a11 * a22 - a12 * a12, trace = a11 + a22, rest = 1.0 - det;
  // D_F = det(I + jA) = (1 - det) + j trace. Its root without cancellation: m + 1 - det >= 2 always, as m >= |1 - det|
  // and for det > 1 the matrix is definite, so trace^2 >= 4 det.
  const Real m = Math::root(rest * rest + trace * trace), inverse = 1.0 / m;
  const Real root_real = Math::root(0.5 * (m + rest));
  const Real root_imag = trace / (2.0 * root_real);
  const Real g_squared = phase.g1 * phase.g1 + phase.g2 * phase.g2;
  const Real form = a11 * phase.g1 * phase.g1 + 2.0 * a12 * phase.g1 * phase.g2 + a22 * phase.g2 * phase.g2;
  const Real turned = trace * g_squared - form;
  // The exponent is -variance/2 (g^2 + j turned) / D_F.
  const Real scale = (-0.5 * variance) * inverse * inverse;
  const Real size = Math::exp(scale * (g_squared * rest + turned * trace)) * inverse;
  const ComplexOf<Real> phasor = Math::cis(scale * (turned * rest - g_squared * trace));
  const Real c = size * phasor.re, s = size * phasor.im;
  return {root_real * c + root_imag * s, root_real * s - root_imag * c};
}

template <class Math, class Real>
ECHOPATH_INLINE ComplexOf<Real> edges_footprint_of(const FootprintPhaseOf<Real>& phase, double spread) {
  constexpr double kRoot2 = 1.4142135623730951, kRoot3 = 1.7320508075688772;
  const ComplexOf<Real> once = second_order_footprint_of<Math>(phase, spread);
  const ComplexOf<Real> twice = second_order_footprint_of<Math>(phase, spread * kRoot2);
  const ComplexOf<Real> thrice = second_order_footprint_of<Math>(phase, spread * kRoot3);
  return {3.0 * (once.re - twice.re) + thrice.re, 3.0 * (once.im - twice.im) + thrice.im};
}

// Of one axis.
template <class Math, class Real>
ECHOPATH_INLINE Real flat_top_of(Real g) {
  const Real loss = 1.0 - Math::exp(g * g * -0.125);  // its fourth power needs no more digits
  const Real square = loss * loss;
  return 1.0 - square * square;
}

// How much of what it would send back without a filter a cell may still hide, in [0, 1). Where its phase may be stationary, what a
// point of reflection sends back: its ray met the surface where the waves of neighbours cancel, while the point lies between.
// Elsewhere only edges of the surface can be left, whose waves fall with the phase across the cell. Nothing hides where phases hardly
// turn across the cell, as such rays add up to what there is.
template <class Math, class Real>
ECHOPATH_INLINE Real hidden_part_of(const FootprintPhaseOf<Real>& phase) {
  constexpr double kReach = 0.75;  // cells from the middle: so far may a point be from the nearest ray of a lattice
  constexpr double kTurn = 6.283185307179586, kTiny = 1e-300;
  const Real middle = 0.5 * (phase.h11 + phase.h22), half = 0.5 * (phase.h11 - phase.h22);
  const Real root = Math::root(half * half + phase.h12 * phase.h12);
  const Real first = Math::magnitude(middle + root) + kTiny, second = Math::magnitude(middle - root) + kTiny;
  // g^2 along the axis of the larger h: cosine and sine of twice its angle are half and h12 over the root.
  const Real all = phase.g1 * phase.g1 + phase.g2 * phase.g2;
  const Real turned = half * (phase.g1 * phase.g1 - phase.g2 * phase.g2) + 2.0 * phase.h12 * phase.g1 * phase.g2;
  const Real along = 0.5 * (all + turned / (root + kTiny)), across = all - along, one = all * 0.0 + 1.0;
  // Powers: |integral of e^{jhx^2/2}|^2 = 2 pi/|h| over all x; of e^{jgx} over a cell, cut anyhow, at most 4/g^2.
  const Real at_first = Math::smaller(one, kTurn / first), at_second = Math::smaller(one, kTurn / second);
  const Real at_edge = Math::smaller(one, 4.0 / (all + kTiny));
  const auto is_at_first = along <= (kReach * kReach) * first * first, is_at_second = across <= (kReach * kReach) * second * second;
  const Real of_line = at_edge * (is_at_first ? at_first : is_at_second ? at_second : one);
  const Real left = is_at_first & is_at_second ? at_first * at_second : of_line;
  return Math::root(left) * (1.0 - Math::exp(all * -0.125));
}

}  // namespace echopath
