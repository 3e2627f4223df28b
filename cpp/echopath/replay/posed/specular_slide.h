#pragma once
// Finds how far the points of reflection of a path have slid from the recorded hits, and how that changes its length.
//
// A recorded specular hit moves with its triangle, while the point of reflection slides over the surface (Fermat). For
// tangential slides x of all sliding hits of a path,
//   L(x) = L + g.x + x.Hx/2,   g_k = (a_k - d_k) along the surface,
//   H_kk = P[(I - a a^T)/r_in + (I - d d^T)/r_out]P + n.(d - a) II,   H_kl = -P (R^T (I - a a^T)/r) P
// Here a and d are the directions of arrival and departure, II is the curvature about n (positive where convex), P is the
// projector on the tangent plane and R stands for the flagged mirrors between two sliding hits in a row, k and l. Fermat's
// points lie at x = -H^-1 g, where the path is shorter by e = g.H^-1 g/2, to second order in the slide. H is
// block-tridiagonal; hits with a material point between them are not coupled.
#include <vector>

#include "echopath/replay/posed/path_geometry.h"

namespace echopath {

// Says where sliding hits stand in a replay.
enum class SpecularPoints {
  kMaterial,  // where the trace found them, moving with their triangles
  kFermat,    // one Newton step from there, on the plane or the circle of curvature along the step
};

class SpecularSlide {
 public:
  // Solves for the slides of the path as posed in `hits`, which begins at the antenna position `start` (m, relative to the
  // origin; a reversed path begins at its receiver). Returns false where H is singular: then nothing slides.
  bool solve(const LocalPath& path, const PosedHit* hits, const Vec3& start);

  // Returns e in m, by which the recorded points make the path too long; it is negative where the path is the longest of its
  // neighbours.
  double excess() const { return excess_; }
  // Returns the length in m of the legs that end at sliding hits; a move of these hits changes it as much as the length of
  // the whole path.
  double length() const { return length_; }
  size_t size() const { return points_.size(); }
  int hit(size_t i) const { return points_[i].hit; }  // ascending
  // Returns the tangential step of sliding hit i to Fermat's point, in m; it fades out where it is longer than the shorter
  // leg.
  Vec3 step(size_t i) const;

 private:
  struct Point {
    int hit;
    Vec3 axis[2];  // of the tangent plane, unit
    double reach;  // m, the shorter leg
    Eigen::Vector2d gradient;
    Eigen::Matrix2d hessian, coupling;  // coupling with the next point, zero across a material point
    Eigen::Vector2d slide;
  };
  void add_leg(const LocalPath& path, const PosedHit* hits, int from, int to, const UnfoldedLeg& leg);
  Point* point_at(int hit);
  bool eliminate();

  std::vector<Point> points_;
  double excess_ = 0.0, length_ = 0.0;  // m
};

// Moves the sliding hits of a path as posed in `hits` by one Newton step, as seen from `start` (see SpecularSlide::solve);
// their normals stay. Where H is singular nothing moves.
void step_to_fermat(const LocalPath& path, const Vec3& start, SpecularSlide& scratch, PosedHit* hits);

// Returns the point of the surface to which a tangential step from a hit leads: on the plane, or where the line from the
// centre of curvature meets the circle of curvature along the step. It is exact on spheres, and to third order in the step
// otherwise.
Vec3 surface_point(const PosedHit& hit, const Vec3& step);

}  // namespace echopath
