#pragma once
// Bounds what the filter of a launch cell leaves of a path between any antennas near some, from the waves of these alone:
// most launch cells are dark to a whole array. Math and Real are as in base/lanes/scalar_math.h.
//
// A filter of second order is |F| <= exp(-s^2 n^2 / 2), n = |(I + jA)^-1 g| with A = s^2 h, s the spread. As A is real and
// symmetric, |(I + jA)^-1| <= 1, and for g + dg and A + dA
//   n' >= (n - |dg|) / (1 + |dA|).
// With directions of travel that turn by no more than a on arrival and b on departure, in rad, and t^2 = |T_1|^2 + |T_2|^2,
//   |dg| <= k t (a + b),  |dA| <= s^2 k (3 t^2 (a / in + b / out) + |II| (a + b)),
// where T_1, T_2 are the sides of the cell (CellShape), II its second fundamental form over them (CellShape::second_form),
// and in and out the shortest legs to and from the point: h has squares of the sides' projections across each leg over its
// length; the projections turn by a, which is two of the three parts, and one over the length changes by a / in, which is
// the third.
#include "echopath/replay/kernels/cell_formula.h"

namespace echopath {

// Holds by how much waves may turn, in rad.
template <class Real>
struct TurnedWaves {
  Real arrival, departure;
};

// Returns a bound of the logarithm of flat_top_of, 1 - (1 - e)^4 <= min(1, 4 e) with e = exp(-g^2 / 8).
template <class Math, class Real>
ECHOPATH_INLINE Real largest_flat_top(Real g, Real slack) {
  constexpr double kLog4 = 1.3862943611198906;
  const Real least = Math::larger(Math::magnitude(g) - slack, g * 0.0);
  return Math::smaller(kLog4 - least * least * 0.125, g * 0.0);
}

// Returns a bound of the logarithm of the second-order filter.
template <class Math, class Real>
ECHOPATH_INLINE Real largest_quadratic(const FootprintPhaseOf<Real>& phase, double spread, Real slack_g, Real slack_a) {
  const double variance = spread * spread;
  const Real a11 = variance * phase.h11, a12 = variance * phase.h12, a22 = variance * phase.h22;
  const Real rest = 1.0 - (a11 * a22 - a12 * a12), trace = a11 + a22;
  const Real x = a22 * phase.g1 - a12 * phase.g2, y = a11 * phase.g2 - a12 * phase.g1;
  const Real square = (phase.g1 * phase.g1 + phase.g2 * phase.g2 + x * x + y * y) / (rest * rest + trace * trace);
  const Real least = Math::larger(Math::root(square) - slack_g, square * 0.0) / (1.0 + slack_a);
  return (-0.5 * variance) * least * least;
}

// Returns a bound of the logarithm of the size of cell_filter_of, for a filter of at most second order. `at` has signed
// cosines and side 1; lengths are those of the waves less what they may be shorter.
template <class Math, class Real>
ECHOPATH_INLINE Real largest_cell_filter(const CellShape& cell, const CellWaves<Real>& at, const TurnedWaves<Real>& turned,
                                         const CellFilter& filter) {
  const Real zero = at.cos_in * 0.0;
  if (filter.order == Footprint::kNone || !cell.is_known) return zero;
  const double variance = filter.spread * filter.spread;
  const double square = cell.product[0] + cell.product[2], side = __builtin_sqrt(square);
  const double form_size =
      __builtin_sqrt(cell.second_form[0] * cell.second_form[0] + 2.0 * cell.second_form[1] * cell.second_form[1] +
                     cell.second_form[2] * cell.second_form[2]);
  const double per_side = filter.wavenumber * filter.view.side;
  const Real turn = turned.arrival + turned.departure;
  // This is the change of h, where one over the shortest leg is at most (1 + a) over the leg.
  const Real change = 3.0 * square *
                      (turned.arrival * (1.0 + turned.arrival) * at.inverse_in +
                       turned.departure * (1.0 + turned.departure) * at.inverse_out);
  const Real slack_g = (per_side * side) * turn,
             slack_a = (variance * per_side * filter.view.side) * (change + form_size * turn);
  const FootprintPhaseOf<Real> phase = cell_phase(cell, at, filter);
  if (filter.order == Footprint::kFirstOrder) {
    const Real g = Math::root(phase.g1 * phase.g1 + phase.g2 * phase.g2), least = Math::larger(g - slack_g, zero);
    return least * least * (-1.0 / 24.0);
  }
  if (cell.is_curved || cell.flatness == Flatness::kCurved)
    return largest_quadratic<Math>(phase, filter.spread, slack_g, slack_a);
  if (cell.flatness == Flatness::kFlat) {
    const Real flat = largest_flat_top<Math>(phase.g1, slack_g) + largest_flat_top<Math>(phase.g2, slack_g);
    return Math::larger(flat, largest_quadratic<Math>(phase, filter.spread, slack_g, slack_a));
  }
  const CylinderPhase<Real> axes = cylinder_phase(cell, phase);
  return largest_flat_top<Math>(axes.along, slack_g) + largest_quadratic<Math>(axes.across, filter.spread, slack_g, slack_a);
}

}  // namespace echopath
