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
  kJones,   // field vectors; a matrix from transmit to receive components is kept per coherent path
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

}  // namespace echopath
