#include "echopath/trace/connect/mirror_orders.h"

#include <algorithm>
#include <cmath>

namespace echopath {
namespace {

// An unflagged surface that covers a smaller share of the Fresnel zone is no mirror for diffuse echoes.
constexpr double kHeldShare = 0.5;

// Limits of the quality of a family's own order over that of the opposite one: below the first it comes as the reversal,
// above the second from its own rays, between them from both.
constexpr double kReversed = 0.125, kOwn = 0.5;

// With this share of its zone or more, a mirror may win an order by the density of its rays: denser rays do not mend the
// error of geometrical optics.
constexpr double kSound = 0.7;

// Returns the quality of an order over that of the opposite one, from the covers of their mirrors and the resolution of the
// first over that of the second.
double quality_of_order(double cover, double opposite_cover, double resolution) {
  const double soundness = std::max(0.0, (opposite_cover - kSound) / (1.0 - kSound));
  const double ratio = cover / opposite_cover * std::pow(std::min(1.0, resolution), soundness);
  return ratio * ratio;
}

double share_of_own_order(double quality) {
  return std::clamp(std::log(quality / kReversed) / std::log(kOwn / kReversed), 0.0, 1.0);
}

// Of orders of the same quality each has its own rays alone.
constexpr OrderShares kEqualOrders{1.0, 0.0};

}  // namespace

OrderShares order_shares(double cover, double opposite_cover) {
  return {share_of_own_order(quality_of_order(cover, opposite_cover, 1.0)),
          1.0 - share_of_own_order(quality_of_order(opposite_cover, cover, 1.0))};
}

// Follows fields where `target` is given.
ZoneCover MirrorOrders::cover_of(const MirrorView& view, const ZoneTarget* target, int64_t& num_queries) const {
  const double wavelength = context_.wavelength;
  if (!view.point.is_smooth) return cover_of_zone(context_.geometry, view, target, wavelength, num_queries);
  const double zone = 2.0 * zone_axes(view, wavelength)[0].half;
  const double share = std::min(1.0, context_.surfaces.smooth_width(view.point.hit.mesh_id) / zone);
  return {share * share, 1.0};
}

PathEnd MirrorOrders::end_at(const MirrorView& view, const ZoneCover& cover) const {
  PathEnd end{std::max(cover.share, 1e-9), 1.0, view.before, view.behind, view.point.is_smooth};
  if (!end.is_smooth) return end;
  for (const ZoneAxis& axis : zone_axes(view, context_.wavelength)) end.spread *= axis.spread;
  return end;
}

void MirrorOrders::weigh(Ray& ray, const SurfaceHit& surface, int64_t& num_queries) const {
  ray.is_mirror_unweighed = false;
  const MirrorView view{ray.mirror, ray.mirror_arrival, ray.mirror_length, surface.point.distance};
  const ZoneTarget target{surface.point, ray.direction};
  const ZoneCover cover = cover_of(view, ray.coherent ? &target : nullptr, num_queries);
  ray.field_factor *= cover.field;
  ray.holds_zones = ray.holds_zones && cover.share >= kHeldShare;
  if (ray.num_mirrors == 1) ray.first_mirror = end_at(view, cover);
}

OrderShares MirrorOrders::shares(const Ray& ray, const SurfaceHit& surface, const Leg& leg, int64_t& num_queries) const {
  const MirrorView view{surface.point, ray.direction, leg.length, surface.point.distance};
  const PathEnd last = end_at(view, cover_of(view, nullptr, num_queries));
  const double resolution = resolution_of(ray, surface, leg, last);
  if (resolution == 1.0 && ray.first_mirror.cover == last.cover) return kEqualOrders;
  const double own = quality_of_order(ray.first_mirror.cover, last.cover, resolution);
  const double opposite = quality_of_order(last.cover, ray.first_mirror.cover, 1.0 / resolution);
  return {share_of_own_order(own), 1.0 - share_of_own_order(opposite)};
}

// Returns the rays per Fresnel zone on the last surface over those on the first one in the opposite order. Both orders carry
// the same field, which by stationary phase is that of the tube (density over root of its area) times the zone. It is 1
// between facets, because the facets of a curved body do not tell how much they spread the rays.
double MirrorOrders::resolution_of(const Ray& ray, const SurfaceHit& surface, const Leg& leg, const PathEnd& last) const {
  const PathEnd& first = ray.first_mirror;
  if (!first.is_smooth && !last.is_smooth) return 1.0;
  const auto tube = [](const PathEnd& end) {
    return end.to_antenna * (end.to_antenna + end.to_next) * std::sqrt(end.spread);
  };
  const LaunchPlan& plan = context_.plan;
  const double opposite_density = plan.density(plan.owners.owner(surface.point.hit.mesh_id, leg.sequence));
  return ray.launch_density * tube(last) / (opposite_density * tube(first));
}

}  // namespace echopath
