#pragma once
// Polarised fields: reflection and physical optics of a complex field vector, e^{+jwt}.
#include <array>
#include <complex>

#include "echopath/base/geometry.h"
#include "echopath/em/material.h"

namespace echopath {

using FieldVector = Eigen::Vector3cd;

// Fields of a horizontal and of a vertical launch of unit strength, as they are somewhere along a path.
using FieldPair = std::array<FieldVector, 2>;

// (rx h, tx h), (rx h, tx v), (rx v, tx h), (rx v, tx v): from launched to arriving components.
using JonesMatrix = std::array<std::complex<float>, 4>;

enum class PolarizationModel {
  kScalar,  // one coefficient a hit, TE or TM by the transmit polarisation; costs nothing
  kJones,   // field vectors; a matrix from transmit to receive components is kept per path
};

// Two unit vectors across a direction of travel: `horizontal` lies in the xy-plane, `vertical` = direction x horizontal points
// up (for a direction along z: x and y of the world serve).
struct TransverseBasis {
  Vec3 horizontal, vertical;
};
TransverseBasis transverse_basis(const Vec3& direction);

// The two launches along a direction, and the components across the direction of arrival of what has become of them.
FieldPair launched_fields(const Vec3& direction);
JonesMatrix arriving_components(const FieldPair& fields, const Vec3& direction);
// Likewise along two fields in the place of both axes.
JonesMatrix components(const FieldPair& fields, const FieldPair& axes);

// Components (horizontal, vertical) of a polarisation vector across a direction, of length 1; zero along the direction.
Eigen::Vector2d transverse_components(const Vec3& polarization, const Vec3& direction);

// Fresnel coefficients of both modes. A conductor: -1 and +1; a constant reflectivity rho: -sqrt(rho) and +sqrt(rho).
struct ModeCoefficients {
  std::complex<double> te, tm;
};
ModeCoefficients mode_coefficients(const Material& material, double frequency, double cos_incidence);

// Field behind a mirror: Gamma_TE (E.s) s + Gamma_TM (E.p_i) p_r with s = k x n, p = s x k. `normal` is a unit vector on the
// incident side.
FieldVector reflected_field(const FieldVector& incident, const Vec3& direction, const Vec3& normal,
                            const ModeCoefficients& coefficients);

// Physical optics: what takes the place of Gamma K E for radiation along the unit vector `out`:
// -(1/2) out x [n x E_t - out x (n x (k_i x E_i + k_r x E_r))], E_t = E_i + E_r. On a conductor that is
// -[E cos_i + k_i (n.E)] across `out`. The coefficient of a conductor's TM part grows as 1/cos_i against the scalar K = cos_i.
FieldVector radiated_field(const FieldVector& incident, const Vec3& direction, const Vec3& normal, const Vec3& out,
                           const ModeCoefficients& coefficients);

// How one diffuse hit turns polarisations.
struct Depolarization {
  double cross_share = 0.0;  // mean share of power across the polarisation that came, in [0, 0.5]
  double axis = 0.0;         // rad in [0, pi), random per hit
};

// Diffuse scattering: what takes the place of |Gamma| E for power that leaves along the unit vector `out`.
// `reflection` of the field is left, a magnitude (SurfaceResponse::facet); it turns as on a metal facet that mirrors
// `direction` into `out`, so that a co-polarised radar sees all of it, in any orientation. Before, two waves in quadrature
// share it: one with 1 - 2 K of the power as it is, one with 2 K mirrored at an axis across the direction, at the angle `axis` from the
// normal of the scattering plane. Averaged over axes every linear polarisation has K of its power in the cross one, by no
// hit is power gained or lost, and swapping both ends transposes the matrix. No surface that is reciprocal and has no
// preferred axis turns more than half. With K = 1/4 it scatters like a cloud of thin needles.
// Sources: K is K_x of Degli-Esposti et al. 2011; Nghiem et al. 1992 (reciprocal media without a preferred axis:
// <hh vv*> = <|hh|^2> - 2 <|hv|^2>); Freeman and Durden 1998 (needles).
FieldVector scattered_field(const FieldVector& incident, const Vec3& direction, const Vec3& out, double reflection,
                            const Depolarization& depolarization);

}  // namespace echopath
