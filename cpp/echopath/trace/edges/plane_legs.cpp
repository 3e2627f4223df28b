#include "echopath/trace/edges/plane_legs.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/record/near_antenna.h"
#include "echopath/trace/mirrors/mirror_zone.h"
#include "echopath/trace/mirrors/mirrors.h"

namespace echopath {
namespace {

constexpr double kLeastOffPlane = 1e-4;  // m: a point this near a plane has no leg over it
constexpr double kPointAside = 1e-5;     // m: a leg is that of points so far to either side, half of each
constexpr double kMirrorsAll = 0.5;      // share of the Fresnel zone with which a plane mirrors the whole field
constexpr double kZonesToRim = 4.0;      // half Fresnel zones: rims farther off count as so far
// No scene is likely to be built along this direction.
const Vec3 kShiftOfPoint = Vec3(0.5320508076, -0.4515026222, 0.7163118961).normalized();

}  // namespace

std::optional<PlaneLeg> PlaneLegFinder::find(const Vec3& point, const Vec3& outward, const Vec3& antenna,
                                             const LitPlane& over, int64_t& num_queries) const {
  std::vector<Vec3> images(over.mirrors.size());
  find_images(chain_of(lit_.planes(), over.mirrors), antenna, images.data());
  const Vec3 lit = plane(over.plane).normal_toward(images.back());
  const Vec3 along = (kShiftOfPoint - lit.dot(kShiftOfPoint) * lit).normalized();
  const Vec3 lift = (outward + lit).normalized();
  PlaneLeg found;
  int num_found = 0;
  for (const double side : {1.0, -1.0}) {
    PlaneLeg leg;
    if (follow(point + side * kPointAside * along, lift, antenna, images, over, leg, num_queries) && num_found++ == 0)
      found = std::move(leg);
  }
  if (num_found == 0) return std::nullopt;
  found.share = 0.5 * num_found;
  found.length = (images.back() - point).norm();
  found.to_antenna = (images.back() - point) / found.length;
  found.at_antenna = (found.bounces.back().position - antenna).normalized();
  weigh(point, antenna, found, num_queries);
  if (std::abs(found.gain) == 0) return std::nullopt;
  return found;
}

// `images` are those of the antenna over the first mirrors.
bool PlaneLegFinder::follow(const Vec3& point, const Vec3& lift, const Vec3& antenna, const std::vector<Vec3>& images,
                            const LitPlane& over, PlaneLeg& leg, int64_t& num_queries) const {
  Vec3 position = point, from = geometry_.lifted(point, lift);
  for (size_t k = over.mirrors.size(); k-- > 0;) {
    RayHit& met = leg.bounces.emplace_back();
    if (!bounce(from, position, images[k], over.mirrors[k], met, num_queries)) return false;
    position = met.position;
    from = geometry_.lifted(position, met.normal);
  }
  ++num_queries;
  return reaches_antenna((position - antenna).norm()) && !geometry_.occluded(from, antenna);
}

// Looks from a point toward an image behind the plane, and finds the point where the wave meets the plane.
bool PlaneLegFinder::bounce(const Vec3& from, const Vec3& position, const Vec3& image, int index, RayHit& met,
                            int64_t& num_queries) const {
  const Plane& mirror = this->plane(index);
  if (!mirror.lies_between(position, image) || std::abs(mirror.height(position)) < kLeastOffPlane) return false;
  const Vec3 line = mirror.met_on_line(position, image) - from;
  const double length = line.norm();
  ++num_queries;
  if (geometry_.intersect_from_surface(from, line / length, met) != EmbreeScene::Verdict::kHit) return false;
  return !met.is_smooth && lit_.plane_of(met.hit) == index;
}

double PlaneLegFinder::cover_of(const RayHit& point, const Vec3& arrival, double before, double behind,
                                int64_t& num_queries) const {
  const MirrorView view{point, arrival, before, behind};
  return cover_of_zone(geometry_, view, nullptr, kSpeedOfLight / settings_.frequency, num_queries).share;
}

// Sets the coefficients, seen by a wave that travels to the antenna, and how much of it the planes mirror.
void PlaneLegFinder::weigh(const Vec3& point, const Vec3& antenna, PlaneLeg& leg, int64_t& num_queries) const {
  Vec3 position = point;
  double travelled = 0.0;
  for (size_t k = 0; k < leg.bounces.size(); ++k) {
    const RayHit& met = leg.bounces[k];
    const Vec3 direction = (met.position - position).normalized();
    const double behind = (met.position - position).norm();
    travelled += behind;
    const SurfaceModel model(*scene_.node_of(met.hit.mesh_id).material, settings_.frequency);
    const SurfaceResponse response = respond_as_mirror(model, settings_.polarization, direction, met.normal);
    leg.gain *= response.gamma * response.coherent;
    const Vec3 next = k + 1 < leg.bounces.size() ? leg.bounces[k + 1].position : antenna;
    leg.first_cover = cover_of(met, (met.position - next).normalized(), leg.length - travelled, behind, num_queries);
    leg.share *= std::min(1.0, leg.first_cover / kMirrorsAll);
    position = met.position;
  }
}

std::complex<double> PlaneLegFinder::field_beside_rims(const Vec3& point, const Vec3& antenna, const PlaneLeg& leg,
                                                       int64_t& num_queries) const {
  const double wavelength = kSpeedOfLight / settings_.frequency, gap = geometry_.plane_tolerance(wavelength);
  const RayHit& met = leg.bounces.front();
  const Vec3 next = leg.bounces.size() > 1 ? leg.bounces[1].position : antenna;
  const double behind = (met.position - point).norm();
  const MirrorView view{met, (met.position - next).normalized(), leg.length - behind, behind};
  const SurfaceAround around(geometry_, met, gap, num_queries);
  std::complex<double> field = 1.0;
  for (const ZoneAxis& axis : zone_axes(view, wavelength)) {
    const double reach = kZonesToRim * axis.half;
    std::complex<double> left = -1.0;
    for (const Vec3& way : {axis.along, Vec3(-axis.along)})
      left += field_beside_edge(around.find_end(way, reach).distance / axis.half);
    field *= left;
  }
  return field;
}

}  // namespace echopath
