#pragma once
// Computes the footprint filter of a launch cell (launch_cell.h) for doubles and for vectors of doubles; Math is as in
// base/lanes/scalar_math.h.
#include "echopath/em/footprint_formula.h"

namespace echopath {

// Flatness is a property of the surface, not of the cell: a filter that changed its kind where cells grow (toward grazing)
// would draw an edge across the surface, and the edge would radiate.
enum class Flatness { kFlat, kFlatOneWay, kCurved };

// Says with what a launch cell weights its ray.
enum class CellWeight {
  kFilter,  // the footprint filter
  kPoints,  // BetweenRays::points, without a filter
  kEdges,   // BetweenRays::edges
};

// Says how launch cells are looked at.
struct CellView {
  double side = 1.0;  // relative to those of the launch, for kFilter: shows the effect of finer or coarser cells
  CellWeight weight = CellWeight::kFilter;
};

struct CellFilter {
  double wavenumber = 0.0;  // rad/m
  double spread = 0.65;     // of the second order's Gaussian, in cells (record/sampler.h)
  Footprint order = Footprint::kSecondOrder;
  CellView view;
};

inline constexpr double kNoFacets = 1e150;  // m^2, of a surface whose triangles go on as one

// Describes a cell with tangents T_a on its surface. Pairs stand as 11, 12, 22. The shape does not change while its mesh
// moves rigidly.
struct CellShape {
  bool is_known = false;   // else the filter is off
  bool is_curved = false;  // behind a curved specular bounce: `turn` is that of the trace
  Flatness flatness = Flatness::kFlat;
  double product[3] = {0, 0, 0};      // T_a.T_b, m^2
  double turn[3] = {0, 0, 0};         // T_a.U_b, m
  double second_form[3] = {0, 0, 0};  // II(T_a, T_b) about the normal of the triangle, m
  double across[2] = {1, 0};          // of kFlatOneWay: unit, in cells, toward the curvature
  bool is_coarse = false;             // is_coarse_cell
};

// Describes the ray tube of a launch on a flat surface.
template <class Real>
struct TubeOnPlane {
  Real along, across;  // m, sides of its cell: in the plane of incidence and across
};

// `length` is the unfolded one to the point, in m, and `density` is in rays per sr.
template <class Math, class Real>
ECHOPATH_INLINE TubeOnPlane<Real> tube_on_plane(Real length, Real density, Real cos_in) {
  const Real side = length / Math::root(density);
  return {side / Math::larger(Math::magnitude(cos_in), Real{} + 1e-3), side};
}

// Returns whether the sine of the angle of incidence tells the plane of incidence: else the cell may lie in any way.
template <class Real>
ECHOPATH_INLINE auto has_plane_of_incidence(Real sine) {
  return sine > 1e-9;
}

// Describes the cell as waves meet and leave it.
template <class Real>
struct CellWaves {
  Real cos_in, cos_out;                       // positive
  Real side;                                  // 1 where the wave arrives from the normal's side, else -1
  Real inverse_in, inverse_out;               // 1/m, of the unfolded lengths
  Real along_arrival[2], along_departure[2];  // of unit directions of travel, T_a.u and T_a.s, m
};

// Returns the gradient g of the phase in rad per cell, and the matrix h in rad per cell^2. Shape is CellShape, or a type
// like it that holds as many cells as Real has lanes.
template <class Shape, class Real>
ECHOPATH_INLINE FootprintPhaseOf<Real> cell_phase(const Shape& cell, const CellWaves<Real>& at, const CellFilter& filter) {
  const double per_side = filter.wavenumber * filter.view.side, per_area = per_side * filter.view.side;
  FootprintPhaseOf<Real> phase;
  Real* const h[3] = {&phase.h11, &phase.h12, &phase.h22};
  const Real path_per_height = at.side * (at.cos_in + at.cos_out);
  for (int i = 0; i < 3; ++i) {
    const int a = i == 2 ? 1 : 0, b = i == 0 ? 0 : 1;
    const Real on_arrival = (cell.product[i] - at.along_arrival[a] * at.along_arrival[b]) * at.inverse_in;
    const Real on_departure = (cell.product[i] - at.along_departure[a] * at.along_departure[b]) * at.inverse_out;
    *h[i] = per_area * ((cell.is_curved ? on_arrival * 0.0 + cell.turn[i] : on_arrival) + on_departure +
                        path_per_height * cell.second_form[i]);
  }
  phase.g1 = per_side * (at.along_arrival[0] - at.along_departure[0]);
  phase.g2 = per_side * (at.along_arrival[1] - at.along_departure[1]);
  return phase;
}

// Leaves a filter whole, with its turn: the phase that goes through many cycles behind curved bounces (TurningFootprint).
struct WithTurn {
  // Returns the filter.
  template <class Math, class Real>
  ECHOPATH_INLINE ComplexOf<Real> second_order(const FootprintPhaseOf<Real>& phase, double spread) {
    return second_order_footprint_of<Math>(phase, spread);
  }
  template <class Mask>
  ECHOPATH_INLINE void keep_where(const Mask& /*is_quadratic*/) {}
};

// Takes the turn out of a filter and keeps it: 0 where the filter has none.
template <class Real>
struct TurnApart {
  Real turn{};  // rad

  // Returns the filter without its turn.
  template <class Math, class>
  ECHOPATH_INLINE ComplexOf<Real> second_order(const FootprintPhaseOf<Real>& phase, double spread) {
    const TurningFootprint<Real> found = turning_footprint_of<Math>(phase, spread);
    turn = found.turn;
    return {found.root.re * found.size, -(found.root.im * found.size)};
  }
  template <class Mask>
  ECHOPATH_INLINE void keep_where(const Mask& is_quadratic) {
    turn = is_quadratic ? turn : turn * 0.0;
  }
};

// Returns the filter of the second order. Turn is WithTurn or TurnApart, here and below. Footprint::kEdges sums up
// several turns, so that none stands apart.
template <class Math, class Real, class Turn>
ECHOPATH_INLINE ComplexOf<Real> quadratic_footprint(const FootprintPhaseOf<Real>& phase, const CellFilter& filter,
                                                    Turn& turn) {
  return filter.order == Footprint::kEdges ? edges_footprint_of<Math>(phase, filter.spread)
                                           : turn.template second_order<Math, Real>(phase, filter.spread);
}

// A flat facet has a flat-top filter where the phase is nearly linear, else the quadratic one.
template <class Math, class Real, class Turn>
ECHOPATH_INLINE ComplexOf<Real> flat_cell_filter(const FootprintPhaseOf<Real>& phase, const CellFilter& filter, Turn& turn) {
  constexpr double kFlatPhase = 0.05;  // rad: quadratic phase (spread^2 h) below which a flat facet is flat-top
  const Real largest =
      Math::larger(Math::larger(Math::magnitude(phase.h11), Math::magnitude(phase.h22)), Math::magnitude(phase.h12));
  const auto is_bent = largest * (filter.spread * filter.spread) >= kFlatPhase;
  const Real flat = flat_top_of<Math>(phase.g1) * flat_top_of<Math>(phase.g2);
  if (!Math::any(is_bent)) return {flat, flat * 0.0};
  const ComplexOf<Real> bent = quadratic_footprint<Math>(phase, filter, turn);
  turn.keep_where(is_bent);
  return {is_bent ? bent.re : flat, is_bent ? bent.im : flat * 0.0};
}

// Holds the phase over a cell on a cylinder, by the cylinder's own axes.
template <class Real>
struct CylinderPhase {
  FootprintPhaseOf<Real> across;
  Real along;  // gradient along the axis, rad per cell
};
template <class Real>
ECHOPATH_INLINE CylinderPhase<Real> cylinder_phase(const CellShape& cell, const FootprintPhaseOf<Real>& phase) {
  const double x = cell.across[0], y = cell.across[1];
  CylinderPhase<Real> turned{};
  turned.across.g1 = x * phase.g1 + y * phase.g2;
  turned.across.h11 = x * x * phase.h11 + 2.0 * x * y * phase.h12 + y * y * phase.h22;
  turned.along = x * phase.g2 - y * phase.g1;
  return turned;
}

// Along the axis of a cylinder the facets are as long as the cylinder: the filter is flat-top there and of second order
// across.
template <class Math, class Real, class Turn>
ECHOPATH_INLINE ComplexOf<Real> cylinder_cell_filter(const CellShape& cell, const FootprintPhaseOf<Real>& phase,
                                                     const CellFilter& filter, Turn& turn) {
  const CylinderPhase<Real> turned = cylinder_phase(cell, phase);
  const Real flat = flat_top_of<Math>(turned.along);
  const ComplexOf<Real> bent = quadratic_footprint<Math>(turned.across, filter, turn);
  return {flat * bent.re, flat * bent.im};
}

// The currents of a curved surface fade out toward the lines where it stops being lit or seen, by the factor 4 cos_in
// cos_out/(cos_in + cos_out)^2. The factor is one where the surface mirrors and has no slope there, so that the echo of
// geometrical optics stays; for antennas at one place it is one everywhere. Currents that end at the line where the receiver
// loses sight of them would radiate an edge wave that the body does not have: without the taper a sphere of ka 161 errs by
// up to .9 dB up to 120 degrees between both ways, the more the better the rays resolve the line; with it by .03 dB (against
// Mie).
template <class Real>
ECHOPATH_INLINE Real shadow_taper(const CellWaves<Real>& at) {
  const Real sum = at.cos_in + at.cos_out;
  return 4.0 * at.cos_in * at.cos_out / (sum * sum);
}

// Returns whether a cell is wider than the facets of its mesh, so that its own facet tells nothing of the others. Its
// narrower side counts, because toward grazing the other side says how the ray lies, not how far apart rays are. `product`
// is CellShape::product.
template <class Math, class Real>
ECHOPATH_INLINE auto is_coarse_cell(const Real* product, double facet_area) {
  const Real half = 0.5 * (product[0] - product[2]);
  const Real narrow = 0.5 * (product[0] + product[2]) - Math::root(half * half + product[1] * product[1]);
  return narrow > facet_area;
}

// Returns the BetweenRays of a cell; a coarse cell may hold any wave. `is_coarse` is a truth value or a mask of lanes.
template <class Math, class Shape, class Mask, class Real>
ECHOPATH_INLINE Real between_rays_of_cell(const Shape& cell, const Mask& is_coarse, const CellWaves<Real>& at,
                                          const CellFilter& filter) {
  const BetweenRays<Real> found = between_rays_of<Math>(cell_phase(cell, at, filter));
  const Real zero = found.points * 0.0;
  if (filter.view.weight == CellWeight::kPoints) return is_coarse ? zero + 1.0 : found.points;
  return is_coarse ? zero : found.edges;
}

template <class Math, class Real, class Turn>
ECHOPATH_INLINE ComplexOf<Real> cell_filter_of(const CellShape& cell, const CellWaves<Real>& at, const CellFilter& filter,
                                               Turn& turn) {
  const Real zero = at.cos_in * 0.0;
  const bool is_filter = filter.view.weight == CellWeight::kFilter;
  if (filter.order == Footprint::kNone || !cell.is_known) return {is_filter ? zero + 1.0 : zero, zero};
  if (!is_filter) return {between_rays_of_cell<Math>(cell, cell.is_coarse, at, filter), zero};
  const FootprintPhaseOf<Real> phase = cell_phase(cell, at, filter);
  if (filter.order == Footprint::kFirstOrder) return {first_order_footprint_of<Math>(phase), zero};
  if (cell.flatness == Flatness::kFlat) {
    return cell.is_curved ? quadratic_footprint<Math>(phase, filter, turn) : flat_cell_filter<Math>(phase, filter, turn);
  }
  const ComplexOf<Real> factor = cell.flatness == Flatness::kFlatOneWay && !cell.is_curved
                                     ? cylinder_cell_filter<Math>(cell, phase, filter, turn)
                                     : quadratic_footprint<Math>(phase, filter, turn);
  const Real taper = shadow_taper(at);
  return {taper * factor.re, taper * factor.im};
}

template <class Math, class Real>
ECHOPATH_INLINE ComplexOf<Real> cell_filter_of(const CellShape& cell, const CellWaves<Real>& at, const CellFilter& filter) {
  WithTurn turn;
  return cell_filter_of<Math>(cell, at, filter, turn);
}

}  // namespace echopath
