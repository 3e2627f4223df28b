#pragma once
// Computes in the same way for one ray and, in loops over lanes, for all of a packet.
#include "echopath/base/lanes/scalar_math.h"
#include "echopath/base/vector_of.h"

namespace echopath {

// Returns by how much (m^2) the radius of the sphere around the receiver exceeds the distance at which a ray passes it,
// squares of both. The ray leaves a point toward `direction` after a way of `length` (m); `density` is in rays per sr.
ECHOPATH_INLINE double reach_of(const VectorOf<double>& to_receiver, const VectorOf<double>& direction, double length,
                                double density) {
  constexpr double kSpacings = 2.0;  // of rays: a dozen rays of each path meet the sphere
  const double ahead = dot(to_receiver, direction), squared = dot(to_receiver, to_receiver);
  const double whole = length + ScalarMath::root(squared), radius = kSpacings * whole;
  const double reach = radius * radius / density - (squared - ahead * ahead);
  return ahead > 0.0 ? reach : -1.0;
}

// Returns the direction whose components along two axes across the unit normal and along the normal are given. The axes turn
// smoothly except where the normal has a z of kAxesTurn (Duff et al. 2017, "Building an orthonormal basis, revisited"; there
// it is 0): few surfaces have this slope, and rounding decides on which side of it they lie.
inline constexpr double kAxesTurn = -0.3217;

ECHOPATH_INLINE VectorOf<double> over_surface(const VectorOf<double>& normal, const VectorOf<double>& local) {
  const double sign = normal.z < kAxesTurn ? -1.0 : 1.0;
  const double a = -1.0 / (sign + normal.z), b = normal.x * normal.y * a;
  const VectorOf<double> first{1.0 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x};
  const VectorOf<double> second{b, sign + normal.y * normal.y * a, -normal.y};
  return local.x * first + local.y * second + local.z * normal;
}

// Returns the unit direction after reflection of a ray that arrives along `direction`. Unlike that of base/plane.h it knows
// the cosine of incidence, and it makes the direction a unit vector again, so that rounding does not grow with the bounces.
ECHOPATH_INLINE VectorOf<double> mirrored(const VectorOf<double>& direction, const VectorOf<double>& normal,
                                          double cos_incidence) {
  const VectorOf<double> out = direction + (2.0 * cos_incidence) * normal;
  return (1.0 / ScalarMath::root(dot(out, out))) * out;
}

}  // namespace echopath
