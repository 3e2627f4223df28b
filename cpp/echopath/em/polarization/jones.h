#pragma once
// Computes polarised fields: reflection and physical optics of a complex field vector, with the time factor e^{+jwt}.
#include <array>
#include <complex>

#include "echopath/base/geometry.h"
#include "echopath/em/material.h"

namespace echopath {

using FieldVector = Eigen::Vector3cd;

// Holds the fields of a horizontal and of a vertical launch of unit strength, at one point of a path.
using FieldPair = std::array<FieldVector, 2>;

// Maps launched to arriving components: (rx h, tx h), (rx h, tx v), (rx v, tx h), (rx v, tx v).
using JonesMatrix = std::array<std::complex<float>, 4>;

enum class PolarizationModel {
  kScalar,  // one coefficient per hit, TE or TM by the transmit polarisation; costs nothing
  kJones,   // field vectors; a matrix from transmit to receive components is kept per path
};

// Holds two unit vectors across a direction of travel: `horizontal` lies in the xy-plane, `vertical` = direction x
// horizontal points up. For a direction along z they lie along x and y of the world.
struct TransverseBasis {
  Vec3 horizontal, vertical;
};
TransverseBasis transverse_basis(const Vec3& direction);

// launched_fields returns the two launches along a direction; arriving_components returns the components across the
// direction of arrival of what has become of them.
FieldPair launched_fields(const Vec3& direction);
JonesMatrix arriving_components(const FieldPair& fields, const Vec3& direction);
// Returns the components along two fields that serve as axes.
JonesMatrix components(const FieldPair& fields, const FieldPair& axes);

// Holds the Fresnel coefficients of both modes: -1 and +1 for a conductor, -sqrt(rho) and +sqrt(rho) for a constant
// reflectivity.
struct ModeCoefficients {
  std::complex<double> te, tm;
};

// Returns the field behind a mirror, Gamma_TE (E.s) s + Gamma_TM (E.p_i) p_r with s = k x n, p = s x k. `normal` is a unit
// vector on the incident side.
FieldVector reflected_field(const FieldVector& incident, const Vec3& direction, const Vec3& normal,
                            const ModeCoefficients& coefficients);

// Returns the physical-optics field that takes the place of Gamma K E for radiation along the unit vector `out`:
// -(1/2) out x [n x E_t - out x (n x (k_i x E_i + k_r x E_r))], E_t = E_i + E_r. On a conductor that is -[E cos_i + k_i
// (n.E)] across `out`. The coefficient of a conductor's TM part grows as 1/cos_i against the scalar K = cos_i.
FieldVector radiated_field(const FieldVector& incident, const Vec3& direction, const Vec3& normal, const Vec3& out,
                           const ModeCoefficients& coefficients);

// Describes how one diffuse hit turns polarisations.
struct Depolarization {
  double cross_share = 0.0;  // mean share of power in the cross polarisation, in [0, 0.5]
  double axis = 0.0;         // rad in [0, pi), random per hit
};

// Returns the field that takes the place of |Gamma| E for power that is scattered along the unit vector `out`. `reflection`
// is the magnitude of the field that is left (SurfaceResponse::facet). The field turns as on a metal facet that mirrors
// `direction` into `out`, so that a co-polarised radar sees all of it, in any orientation. Before that it is split into two
// waves in quadrature: one with 1 - 2 K of the power stays as it is, one with 2 K is mirrored at an axis across the
// direction, at the angle `axis` from the normal of the scattering plane. Averaged over axes every linear polarisation has K
// of its power in the cross one, no hit gains or loses power, and swapping both ends transposes the matrix. No surface that
// is reciprocal and has no preferred axis turns more than half. With K = 1/4 it scatters like a cloud of thin needles.
// Sources: K is K_x of Degli-Esposti et al. 2011; Nghiem et al. 1992 (reciprocal media without a preferred axis: <hh vv*> =
// <|hh|^2> - 2 <|hv|^2>); Freeman and Durden 1998 (needles).
FieldVector scattered_field(const FieldVector& incident, const Vec3& direction, const Vec3& out, double reflection,
                            const Depolarization& depolarization);

}  // namespace echopath
