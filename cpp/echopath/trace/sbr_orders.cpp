// Unflagged surfaces as mirrors, and which of a path's two orders stands.
//
// Over unflagged surfaces the paths T a ... b R and T b ... a R between nearby antennas are each other's reversal, and rays find
// both: one order takes a for a mirror and integrates over b, the other b and a. Each family of paths can therefore be had in
// two ways, by its own rays or as the reversal of those of the opposite order. Its share of either is a function of what both
// kinds of rays know, the two ends, so that the shares add up to one and nothing counts twice.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "echopath/trace/sbr_state.h"

namespace echopath {
namespace {

// Quality of a family's own order over that of the opposite one: below the first it comes as the reversal, above the second from
// its own rays, between them from both.
constexpr double kReversed = 0.125, kOwn = 0.5;

// Share of its zone from which on a mirror may take an order over for the density of its rays: denser rays do not mend what
// geometrical optics errs.
constexpr double kSound = 0.7;

// Of an order over that of the opposite one, given the covers of their mirrors and the resolution of the first over the second.
double quality_of_order(double cover, double opposite_cover, double resolution) {
  const double soundness = std::max(0.0, (opposite_cover - kSound) / (1.0 - kSound));
  const double ratio = cover / opposite_cover * std::pow(std::min(1.0, resolution), soundness);
  return ratio * ratio;
}

double share_of_own_order(double quality) {
  return std::clamp(std::log(quality / kReversed) / std::log(kOwn / kReversed), 0.0, 1.0);
}

// The middle one of the extents along the principal axes of the vertices: the width of a plate, the diameter of a sphere.
double middle_extent(const std::vector<Vec3>& vertices) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& vertex : vertices) mean += vertex / static_cast<double>(vertices.size());
  Mat3 covariance = Mat3::Zero();
  for (const Vec3& vertex : vertices) covariance += (vertex - mean) * (vertex - mean).transpose();
  const Mat3 axes = Eigen::SelfAdjointEigenSolver<Mat3>(covariance).eigenvectors();
  Eigen::AlignedBox3d box;
  for (const Vec3& vertex : vertices) box.extend(Vec3(axes.transpose() * (vertex - mean)));
  std::array<double, 3> extents = {box.sizes()[0], box.sizes()[1], box.sizes()[2]};
  std::sort(extents.begin(), extents.end());
  return extents[1];
}

}  // namespace

// Of the smooth surface that a mesh is a part of, 0 for meshes of facets: these are looked at where they are hit.
double RayShooter::width_of_smooth(uint32_t mesh_id) const {
  const Node& node = scene_.node_of(mesh_id);
  if (!node.smooth || node.material->mirror) return 0.0;
  const double width = middle_extent(geometry_.vertices(mesh_id));
  if (!node.mesh->whole()) return width;
  // The whole is posed as its part is.
  const double at_rest = middle_extent(node.mesh->vertices());
  return at_rest > 0 ? middle_extent(node.mesh->whole()->vertices()) * (width / at_rest) : width;
}

// `target`: where fields are to be followed.
ZoneCover RayShooter::cover_of(const MirrorView& view, const ZoneTarget* target, PathBlock& block) const {
  if (!view.point.is_smooth) return cover_of_zone(geometry_, view, target, wavelength_, block.statistics.num_queries);
  const double zone = 2.0 * zone_axes(view, wavelength_)[0].half;
  const double share = std::min(1.0, mesh_width_[view.point.hit.mesh_id] / zone);
  return {share * share, 1.0};
}

RayShooter::PathEnd RayShooter::end_at(const MirrorView& view, const ZoneCover& cover) const {
  PathEnd end{std::max(cover.share, 1e-9), 1.0, view.before, view.behind, view.point.is_smooth};
  if (!end.is_smooth) return end;
  for (const ZoneAxis& axis : zone_axes(view, wavelength_)) end.spread *= axis.spread;
  return end;
}

// Back at the last unflagged mirror, now that it is known what lies behind it.
void RayShooter::look_at_mirror(Ray& ray, const Surface& surface, const Scratch& scratch, PathBlock& block) const {
  const MirrorView view{scratch.mirror, scratch.mirror_arrival, ray.leg_length, surface.point.distance};
  const ZoneTarget target{surface.point, ray.direction};
  const ZoneCover cover = cover_of(view, ray.coherent ? &target : nullptr, block);
  ray.field_factor *= cover.field;
  ray.holds_zones = ray.holds_zones && cover.share >= kHeldShare;
  if (ray.num_mirrors == 1) ray.first_mirror = end_at(view, cover);
}

// Of the echo that the ray sends over `leg`. It is the ray's own family in its own order and the opposite family in the opposite
// one.
RayShooter::OrderShares RayShooter::shares_of_orders(const Ray& ray, const Surface& surface, const Leg& leg,
                                                     PathBlock& block) const {
  const MirrorView view{surface.point, ray.direction, leg.length, surface.point.distance};
  const PathEnd last = end_at(view, cover_of(view, nullptr, block));
  const double resolution = resolution_of(ray, surface, leg, last);
  const double own = quality_of_order(ray.first_mirror.cover, last.cover, resolution);
  const double opposite = quality_of_order(last.cover, ray.first_mirror.cover, 1.0 / resolution);
  return {share_of_own_order(own), 1.0 - share_of_own_order(opposite)};
}

// Rays per Fresnel zone on the last surface over those on the first one in the opposite order. Both orders carry the same
// field, which by stationary phase is that of the tube (density over root of its area) times the zone. 1 between facets: those
// of a curved body do not tell how much they spread.
double RayShooter::resolution_of(const Ray& ray, const Surface& surface, const Leg& leg, const PathEnd& last) const {
  const PathEnd& first = ray.first_mirror;
  if (!first.is_smooth && !last.is_smooth) return 1.0;
  const auto tube = [](const PathEnd& end) { return end.to_antenna * (end.to_antenna + end.to_next) * std::sqrt(end.spread); };
  const double opposite_density = plan_.density(plan_.owners.owner(surface.point.hit.mesh_id, leg.sequence));
  return ray.launch_density * tube(last) / (opposite_density * tube(first));
}

}  // namespace echopath
