#pragma once
// Computes what queries ask of Embree and what they make of its answers, in the same way for one ray and, in loops over
// lanes, for all of a packet.
#include "echopath/base/lanes/scalar_math.h"
#include "echopath/base/vector_of.h"

namespace echopath {

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

}  // namespace echopath
