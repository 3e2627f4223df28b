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

struct Facet {
  VectorOf<double> corner, along_u, along_v;  // m
};

// Describes the point of a facet at (u, v), and how it lies to a ray.
struct FacetPoint {
  VectorOf<double> position;
  double distance;     // m, along the ray
  double off_squared;  // m^2, from there

  ECHOPATH_INLINE bool lies_on_ray(double absolute, double relative) const {
    const double allowed = absolute + relative * distance;
    return (distance > 0) & (off_squared <= allowed * allowed);
  }
};

ECHOPATH_INLINE FacetPoint point_of(const Facet& facet, double u, double v, const VectorOf<double>& from,
                                    const VectorOf<double>& direction) {
  FacetPoint point;
  point.position = facet.corner + u * facet.along_u + v * facet.along_v;
  point.distance = dot(direction, point.position - from);
  const VectorOf<double> off = (from + point.distance * direction) - point.position;
  point.off_squared = dot(off, off);
  return point;
}

ECHOPATH_INLINE VectorOf<double> unit_normal(const Facet& facet) {
  const VectorOf<double> normal = cross(facet.along_u, facet.along_v);
  return (1.0 / ScalarMath::root(dot(normal, normal))) * normal;
}

// Returns the side of a normal that the ray meets.
ECHOPATH_INLINE VectorOf<double> turned_against(const VectorOf<double>& direction, const VectorOf<double>& normal) {
  return (dot(normal, direction) > 0 ? -1.0 : 1.0) * normal;
}

// Describes the way between two points as Embree takes it.
struct SegmentRay {
  VectorOf<double> from, direction;
  double far;  // m; negative: the points are too near to each other for anything to lie between them
};

// Returns how far a ray may be moved along its unit direction until it is `reach` (m) before the point next to the origin.
ECHOPATH_INLINE double way_up(const VectorOf<double>& from, const VectorOf<double>& direction, double reach) {
  return ScalarMath::larger(0.0, -dot(from, direction) - reach);
}

// Points nearer than `shortest` (m) are too near for anything to lie between them.
ECHOPATH_INLINE SegmentRay segment_ray(const VectorOf<double>& from, const VectorOf<double>& to, double shortest,
                                       double reach) {
  const VectorOf<double> whole = to - from;
  const double length = ScalarMath::root(dot(whole, whole));
  SegmentRay ray;
  ray.direction = (length > shortest ? 1.0 / length : 0.0) * whole;
  const double moved = way_up(from, ray.direction, reach);
  ray.from = from + moved * ray.direction;
  ray.far = length > shortest ? (length - moved) * (1.0 - 1e-6) : -1.0;
  return ray;
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

// Returns the unit direction after reflection of a ray that arrives along `direction`.
ECHOPATH_INLINE VectorOf<double> mirrored(const VectorOf<double>& normal, const VectorOf<double>& direction,
                                          double cos_incidence) {
  const VectorOf<double> out = direction + (2.0 * cos_incidence) * normal;
  return (1.0 / ScalarMath::root(dot(out, out))) * out;
}

}  // namespace echopath
