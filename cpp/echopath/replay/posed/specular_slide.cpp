#include "echopath/replay/posed/specular_slide.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace echopath {
namespace {

constexpr double kSingular = 1e-9;  // of det H for a flat mirror at normal incidence

double across(const Vec3& first, const Vec3& second, const Vec3& direction) {
  return first.dot(second) - first.dot(direction) * second.dot(direction);
}

}  // namespace

SpecularSlide::Point* SpecularSlide::point_at(int hit) {
  const auto found = std::find_if(points_.rbegin(), points_.rend(), [&](const Point& p) { return p.hit == hit; });
  return found == points_.rend() ? nullptr : &*found;
}

// Adds the contribution of a leg between the hits `from` and `to` (-1: the antenna) to the points at its ends.
void SpecularSlide::add_leg(const LocalPath& path, const PosedHit* hits, int from, int to, const UnfoldedLeg& leg) {
  Point* before = from >= 0 && path.is_sliding(from) ? point_at(from) : nullptr;
  Point* behind = path.is_sliding(to) ? point_at(to) : nullptr;
  const double inverse_length = 1.0 / leg.length;
  length_ += leg.length;
  for (int i = 0; i < 2; ++i) {
    if (before) before->gradient[i] -= before->axis[i].dot(leg.departure);
    if (behind) behind->gradient[i] += behind->axis[i].dot(leg.arrival);
    for (int j = 0; j < 2; ++j) {
      if (before) before->hessian(i, j) += inverse_length * across(before->axis[i], before->axis[j], leg.departure);
      if (behind) behind->hessian(i, j) += inverse_length * across(behind->axis[i], behind->axis[j], leg.arrival);
      if (!before || !behind) continue;
      const Vec3 arriving = mirrored_over(chain_of(hits, from + 1, to), before->axis[i]);
      before->coupling(i, j) = -inverse_length * across(arriving, behind->axis[j], leg.arrival);
    }
  }
  if (before) before->reach = std::min(before->reach, leg.length);
  if (behind) behind->reach = std::min(behind->reach, leg.length);
  for (Point* point : {before, behind}) {
    const PosedHit* hit = point ? &hits[point->hit] : nullptr;
    if (!hit || !hit->is_smooth) continue;
    const double lift = hit->normal.dot(point == before ? leg.departure : Vec3(-leg.arrival));
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) point->hessian(i, j) += lift * point->axis[i].dot(hit->curvature * point->axis[j]);
    }
  }
}

bool SpecularSlide::solve(const LocalPath& path, const PosedHit* hits, const Vec3& start) {
  points_.clear();
  excess_ = length_ = 0.0;
  if (path.sliding == 0) return true;
  for (int k = path.first_material; k < path.last_material; ++k) {
    if (!path.is_sliding(k)) continue;
    const Vec3 first = hits[k].normal.unitOrthogonal(), second = hits[k].normal.cross(first);
    points_.push_back({k,
                       {first, second},
                       std::numeric_limits<double>::infinity(),
                       Eigen::Vector2d::Zero(),
                       Eigen::Matrix2d::Zero(),
                       Eigen::Matrix2d::Zero(),
                       Eigen::Vector2d::Zero()});
  }
  int previous = path.first_material;
  if (path.is_sliding(previous)) {
    add_leg(path, hits, -1, previous, unfolded_leg(hits, start, 0, previous, hits[previous].point));
  }
  for (int k = previous + 1; k <= path.last_material; ++k) {
    if (path.is_image(k)) continue;
    if (path.is_sliding(previous) || path.is_sliding(k)) add_leg(path, hits, previous, k, inner_leg(hits, previous, k));
    previous = k;
  }
  return eliminate();
}

// Solves for the slides by block elimination (LDL^T) and sums e on the way.
bool SpecularSlide::eliminate() {
  Eigen::Matrix2d pivot;
  Eigen::Vector2d rest;
  for (size_t i = 0; i < points_.size(); ++i) {
    Point& at = points_[i];
    const double scale = 1.0 / (at.reach * at.reach);
    pivot = at.hessian;
    rest = at.gradient;
    if (i > 0) {
      const Point& last = points_[i - 1];
      pivot -= last.coupling.transpose() * last.hessian * last.coupling;  // its hessian is inverted by now
      rest -= last.coupling.transpose() * last.slide;
    }
    if (!(std::abs(pivot.determinant()) > kSingular * scale)) {
      points_.clear();
      excess_ = 0.0;
      return false;
    }
    at.hessian = pivot.inverse();
    at.slide = at.hessian * rest;
    excess_ += 0.5 * rest.dot(at.slide);
  }
  for (size_t i = points_.size(); i-- > 0;) {
    Point& at = points_[i];
    if (i + 1 < points_.size()) at.slide += at.hessian * at.coupling * points_[i + 1].slide;
    at.slide = -at.slide;
  }
  return true;
}

Vec3 SpecularSlide::step(size_t i) const {
  const Point& at = points_[i];
  const Vec3 step = at.slide[0] * at.axis[0] + at.slide[1] * at.axis[1];
  // Far beyond the legs the expansion does not hold, so the step fades out. Fading is smooth, so that lengths remain smooth
  // in time.
  const double share = step.squaredNorm() / (at.reach * at.reach);
  return step / (1.0 + share * share);
}

void step_to_fermat(const LocalPath& path, const Vec3& start, SpecularSlide& scratch, PosedHit* hits) {
  if (!scratch.solve(path, hits, start)) return;
  for (size_t i = 0; i < scratch.size(); ++i) {
    PosedHit& hit = hits[scratch.hit(i)];
    hit.point = surface_point(hit, scratch.step(i));
  }
}

Vec3 surface_point(const PosedHit& hit, const Vec3& step) {
  if (!hit.is_smooth) return hit.point + step;
  const double length2 = step.squaredNorm();
  if (length2 == 0) return hit.point;
  const double curvature = step.dot(hit.curvature * step) / length2;
  const double secant = std::sqrt(1.0 + curvature * curvature * length2);
  return hit.point + step / secant - hit.normal * (curvature * length2 / (secant * (1.0 + secant)));
}

}  // namespace echopath
