#include "echopath/trace/legs.h"

#include <cmath>

namespace echopath {
namespace {

constexpr double kOnPlane = 1e-4;  // m: a point this near a mirror's plane has no leg over it
constexpr double kRim = 1e-3;      // m: single precision of the mirrors in the rays' scene, generously

}  // namespace

AntennaView LegFinder::view_of(const Vec3& antenna) const {
  return {antenna, find_beams(antenna, mirrors_, kMaxLegMirrors)};
}

void LegFinder::find(const Vec3& point, const Vec3& normal, const AntennaView& antenna, int max_mirrors, MirrorSequence skip,
                     std::vector<Leg>& legs, int64_t& num_queries) const {
  legs.clear();
  const Vec3 line = antenna.position - point;
  if (skip != kDirect && normal.dot(line) > 0) {
    ++num_queries;
    if (!geometry_.occluded(geometry_.lifted(point, normal), antenna.position)) {
      Leg& leg = legs.emplace_back();
      leg.length = line.norm();
      leg.to_antenna = line / leg.length;
      leg.at_antenna = -leg.to_antenna;
    }
  }
  for (const Beam& beam : antenna.beams) {
    if (static_cast<int>(beam.mirrors.size()) > max_mirrors) break;
    if (beam.sequence == skip) continue;
    Leg leg;
    if (over_mirrors(point, normal, antenna, beam, leg, num_queries)) legs.push_back(leg);
  }
}

bool LegFinder::over_mirrors(const Vec3& point, const Vec3& normal, const AntennaView& antenna, const Beam& beam, Leg& leg,
                             int64_t& num_queries) const {
  const Vec3 line = beam.image() - point;
  const bool is_on_plane = beam.lit_normal.dot(point) - beam.offset < kOnPlane;
  if (normal.dot(line) <= 0 || is_on_plane || !beam.reaches(point, kRim)) return false;
  leg.sequence = beam.sequence;
  leg.length = line.norm();
  leg.to_antenna = leg.at_antenna = line / leg.length;

  // Closest-hit queries answer both whether a mirror is there and whether the way to it is free.
  Vec3 from = geometry_.lifted(point, normal), position = point;
  for (size_t k = beam.mirrors.size(); k-- > 0;) {
    RayHit met;
    ++num_queries;
    if (!bounce(beam.mirrors[k], from, (beam.images[k] - position).normalized(), leg, met)) return false;
    position = met.position;
    from = geometry_.lifted(position, leg.bounces[static_cast<size_t>(leg.num_bounces - 1)].normal);
  }
  ++num_queries;
  if (geometry_.occluded(from, antenna.position)) return false;
  for (int k = 0; k < leg.num_bounces; ++k) {
    leg.at_antenna = mirrors_[static_cast<size_t>(leg.bounces[static_cast<size_t>(k)].mirror)].reflect(leg.at_antenna);
  }
  leg.at_antenna = -leg.at_antenna;
  return std::abs(leg.gain) > 0;
}

// Adds the bounce that a ray from `from` makes next, if it is one off this mirror.
bool LegFinder::bounce(int index, const Vec3& from, const Vec3& direction, Leg& leg, RayHit& met) const {
  const Mirror& mirror = mirrors_[static_cast<size_t>(index)];
  if (geometry_.intersect(from, direction, met) != EmbreeScene::Verdict::kHit) return false;
  if (met.hit.mesh_id != mirror.mesh_id) return false;
  LegBounce& bounce = leg.bounces[static_cast<size_t>(leg.num_bounces++)];
  bounce.mirror = index;
  bounce.hit = met.hit;
  bounce.direction = direction;
  bounce.normal = direction.dot(mirror.normal) < 0 ? mirror.normal : Vec3(-mirror.normal);
  const PolarizationMode mode = polarization_mode(polarization_, direction, mirror.normal);
  const SurfaceResponse response = respond(*mirror.material, frequency_, -direction.dot(bounce.normal), mode);
  leg.gain *= response.gamma * response.coherent;
  bounce.specular_share = response.coherent * response.coherent;
  leg.specular_share *= bounce.specular_share;
  return true;
}

}  // namespace echopath
