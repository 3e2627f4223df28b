#include "echopath/trace/mirrors/plane_bounces.h"

namespace echopath {

void PlaneBounces::add(const Hit& hit, const Vec3& point, const Vec3& normal) {
  RayHit bounce;
  bounce.hit = hit;
  bounce.position = point;
  bounce.normal = lit_normal(point - (points_.empty() ? from_ : points_.back().position), normal);
  bounce.curvature = Mat3::Zero();
  points_.push_back(bounce);
}

MirrorView PlaneBounces::view(size_t bounce) const {
  Vec3 last = from_, leg = Vec3::Zero();
  const auto length_to = [&](const Vec3& point) {
    leg = point - last;
    last = point;
    return leg.norm();
  };
  double before = 0.0, behind = 0.0;
  for (size_t k = 0; k <= bounce; ++k) before += length_to(points_[k].position);
  const Vec3 arrival = leg.normalized();
  for (size_t k = bounce + 1; k < points_.size(); ++k) behind += length_to(points_[k].position);
  behind += length_to(to_);
  return {points_[bounce], arrival, before, behind};
}

std::complex<double> PlaneBounces::field_beside_edges(const EmbreeScene& geometry, double wavelength,
                                                      int64_t& num_queries) const {
  std::complex<double> field = 1.0;
  for (size_t k = 0; k < points_.size(); ++k) {
    Plane next;
    const bool is_last = k + 1 == points_.size();
    if (!is_last) next = {points_[k + 1].position, points_[k + 1].normal};
    field *= field_of_flat_mirror(geometry, view(k), wavelength, num_queries, is_last ? nullptr : &next);
  }
  return field;
}

}  // namespace echopath
