#include "echopath/trace/mirrors/plane_bounces.h"

namespace echopath {
namespace {

constexpr double kParallel = 1e-3;  // sine
constexpr double kMovedOff = 8.0;   // lifts

}  // namespace

void PlaneBounces::add(const Hit& hit, const Vec3& point, const Vec3& normal) {
  RayHit bounce;
  bounce.hit = hit;
  bounce.position = point;
  bounce.normal = lit_normal(point - (points_.empty() ? from_.position : points_.back().position), normal);
  bounce.curvature = Mat3::Zero();
  points_.push_back(bounce);
  beside_.push_back(bounce);
  move_off_edges();
}

// Moves the last point, and those that lie where it does, along their planes off each other's.
void PlaneBounces::move_off_edges() {
  const double aside = kMovedOff * geometry_.lift();
  const auto move = [&](RayHit& point, const Vec3& off) {
    const Vec3 along = off - off.dot(point.normal) * point.normal;
    if (along.norm() > 1e-6) point.position += aside * along.normalized();
  };
  for (size_t k = 0; k + 1 < points_.size(); ++k) {
    if ((points_[k].position - points_.back().position).norm() > aside) continue;
    move(beside_[k], points_.back().normal);
    move(beside_.back(), points_[k].normal);
  }
}

bool PlaneBounces::is_corner_closed(size_t bounce, double wavelength, int64_t& num_queries) const {
  return reaches_plane(bounce, bounce + 1, wavelength, num_queries) &&
         reaches_plane(bounce + 1, bounce, wavelength, num_queries);
}

// Returns whether the plane of a bounce goes on from its point to that of another one. It is true of parallel ones.
bool PlaneBounces::reaches_plane(size_t bounce, size_t other, double wavelength, int64_t& num_queries) const {
  const RayHit& point = beside_[bounce];
  const Plane plane{points_[other].position, points_[other].normal};
  const Vec3 toward = plane.normal.dot(point.normal) * point.normal - plane.normal;
  const double steepness = toward.norm();
  if (steepness < kParallel) return true;
  const double gap = geometry_.plane_tolerance(wavelength), crack = widest_crack(view(bounce), wavelength);
  const SurfaceAround surface(geometry_, point, gap, num_queries, Extent::kPlane, &plane, crack);
  return surface.find_end(toward / steepness, plane.height(point.position) / steepness + 2.0 * crack + 4.0 * gap).is_wall;
}

MirrorView PlaneBounces::view(size_t bounce) const {
  Vec3 last = from_.position, leg = Vec3::Zero();
  const auto length_to = [&](const Vec3& point) {
    leg = point - last;
    last = point;
    return leg.norm();
  };
  double before = 0.0, behind = 0.0;
  for (size_t k = 0; k <= bounce; ++k) before += length_to(points_[k].position);
  const Vec3 arrival = leg.normalized();
  for (size_t k = bounce + 1; k < points_.size(); ++k) behind += length_to(points_[k].position);
  behind += length_to(to_.position);
  return {beside_[bounce], arrival, before, behind};
}

UnfoldedAntennas PlaneBounces::antennas_of(size_t bounce, const MirrorView& view) const {
  Mat3 to_first = Mat3::Identity(), to_last = Mat3::Identity();
  for (size_t k = bounce; k-- > 0;) to_first = reflection(points_[k].normal) * to_first;
  for (size_t k = bounce + 1; k < points_.size(); ++k) to_last = reflection(points_[k].normal) * to_last;
  return {UnfoldedAntenna{from_, -view.before * view.arrival, to_first},
          UnfoldedAntenna{to_, view.behind * mirrored(view.arrival, points_[bounce].normal), to_last}};
}

std::complex<double> PlaneBounces::field_beside_edges(double wavelength, int64_t& num_queries) const {
  std::complex<double> field = 1.0;
  std::vector<Plane> planes;
  for (const RayHit& point : points_) planes.push_back({point.position, point.normal});
  for (size_t k = 0; k < points_.size(); ++k) {
    const MirrorView seen = view(k);
    const Plane* const next = k + 1 == points_.size() ? nullptr : &planes[k + 1];
    field *= field_of_flat_mirror(geometry_, seen, wavelength, antennas_of(k, seen), num_queries, {planes.data(), k}, next);
  }
  return field;
}

}  // namespace echopath
