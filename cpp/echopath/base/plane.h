#pragma once
// Tells what plane mirrors make of points, directions and lines: the image method.
//
// A chain of mirrors is a range of planes, or of what is a Plane, in the order in which a wave meets them.
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "echopath/base/geometry.h"

namespace echopath {

// Returns a direction of travel as it is behind a mirror with this unit normal; the same turns it back.
inline Vec3 mirrored(const Vec3& direction, const Vec3& normal) { return direction - 2.0 * normal.dot(direction) * normal; }

// Returns the matrix that mirrors directions likewise.
inline Mat3 reflection(const Vec3& normal) { return Mat3::Identity() - 2.0 * normal * normal.transpose(); }

// Returns the normal of a surface on the side that a wave along `direction` meets.
inline Vec3 lit_normal(const Vec3& direction, const Vec3& normal) {
  return direction.dot(normal) > 0 ? Vec3(-normal) : normal;
}

struct Plane {
  Vec3 point, normal;  // any point of it, m; unit

  double height(const Vec3& of) const { return normal.dot(of - point); }  // m, on the side of the normal
  Vec3 image(const Vec3& of) const { return of - 2.0 * height(of) * normal; }
  Vec3 mirrored(const Vec3& direction) const { return echopath::mirrored(direction, normal); }
  Vec3 normal_toward(const Vec3& target) const { return height(target) >= 0 ? normal : Vec3(-normal); }
  bool lies_between(const Vec3& a, const Vec3& b) const { return height(a) * height(b) < 0; }
  // Returns where the line through two points of different heights meets the plane: where a wave is mirrored on its way from
  // a point to one whose image is known.
  Vec3 met_on_line(const Vec3& from, const Vec3& image) const {
    const double before = height(from), behind = height(image);
    return from + before / (before - behind) * (image - from);
  }
};

// Returns the plane of the largest of some triangles, whose corners `corners_of` returns by their place. Others may be
// slivers, which tell no plane.
template <class CornersOf>
Plane plane_of_largest(size_t num_triangles, const CornersOf& corners_of) {
  Plane largest{Vec3::Zero(), Vec3::Zero()};  // the normal is as long as twice the area
  for (size_t i = 0; i < num_triangles; ++i) {
    const auto [a, b, c] = corners_of(i);
    const Vec3 normal = cross_of_sides(a, b, c);
    if (normal.squaredNorm() > largest.normal.squaredNorm()) largest = {a, normal};
  }
  return {largest.point, largest.normal.normalized()};
}

// Holds the chain of the mirrors with some indices, by reference.
template <class Mirror>
struct ChainOfIndices {
  const std::vector<Mirror>& mirrors;
  std::span<const int> indices;

  size_t size() const { return indices.size(); }
  const Mirror& operator[](size_t k) const { return mirrors[indices[k]]; }
};

template <class Mirror>
ChainOfIndices<Mirror> chain_of(const std::vector<Mirror>& mirrors, std::span<const int> indices) {
  return {mirrors, indices};
}

// Returns the image of a point over a chain of mirrors; image_over_reversed takes the last one first.
template <class Planes>
Vec3 image_over(const Planes& planes, Vec3 point) {
  for (size_t k = 0; k < planes.size(); ++k) {
    const Plane& plane = planes[k];
    point = plane.image(point);
  }
  return point;
}
template <class Planes>
Vec3 image_over_reversed(const Planes& planes, Vec3 point) {
  for (size_t k = planes.size(); k-- > 0;) {
    const Plane& plane = planes[k];
    point = plane.image(point);
  }
  return point;
}

// Returns the direction behind a chain of mirrors of a wave that travels along `direction` before it;
// mirrored_over_reversed takes the last one first.
template <class Planes>
Vec3 mirrored_over(const Planes& planes, Vec3 direction) {
  for (size_t k = 0; k < planes.size(); ++k) {
    const Plane& plane = planes[k];
    direction = plane.mirrored(direction);
  }
  return direction;
}
template <class Planes>
Vec3 mirrored_over_reversed(const Planes& planes, Vec3 direction) {
  for (size_t k = planes.size(); k-- > 0;) {
    const Plane& plane = planes[k];
    direction = plane.mirrored(direction);
  }
  return direction;
}

// Sets the images of a point over the first mirror of a chain, over the first two, and so on.
template <class Planes>
void find_images(const Planes& planes, Vec3 point, Vec3* images) {
  for (size_t k = 0; k < planes.size(); ++k) {
    const Plane& plane = planes[k];
    images[k] = point = plane.image(point);
  }
}

// Sets points[k] to where a wave between two points meets mirror k of a chain, from the last mirror back to the first.
// Returns the place in the chain of a mirror that does not lie between its neighbours, so that there is no such wave; none
// where all do. A point as near as `touching` (m) to the mirror before it, as at the edge where two mirrors meet, is
// mirrored where it is; with a negative one none is.
template <class Planes>
std::optional<size_t> find_reflections(const Planes& planes, const Vec3& from, const Vec3& to, Vec3* points,
                                       double touching = -1.0) {
  find_images(planes, from, points);
  Vec3 target = to;
  for (size_t k = planes.size(); k-- > 0;) {
    const Plane& plane = planes[k];
    if (std::abs(plane.height(target)) > touching) {
      if (!plane.lies_between(target, points[k])) return k;
      target = plane.met_on_line(target, points[k]);
    }
    points[k] = target;
  }
  return std::nullopt;
}

// Returns a point in which a wave meets mirrors of a chain, lifted by `lift` (m) off all those that it meets within `near`
// (m) of there, to the side of `target`. `points` are those of all mirrors.
template <class Planes>
Vec3 lifted_off_mirrors(const Planes& planes, const Vec3* points, size_t at, const Vec3& target, double near, double lift) {
  Vec3 point = points[at];
  for (size_t k = 0; k < planes.size(); ++k) {
    const Plane& plane = planes[k];
    if ((points[k] - points[at]).norm() <= near) point += lift * plane.normal_toward(target);
  }
  return point;
}

}  // namespace echopath
