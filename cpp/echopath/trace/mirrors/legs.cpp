#include "echopath/trace/mirrors/legs.h"

#include <algorithm>

#include "echopath/record/hit_points.h"
#include "echopath/trace/mirrors/coplanar_mirrors.h"

namespace echopath {
namespace {

constexpr double kNoLegWithin = 1e-4;  // m: a point this near a mirror's plane has no leg over it
constexpr double kRim = 1e-3;          // m: single precision of the mirrors in the rays' scene, generously

}  // namespace

LegFinder::LegFinder(const EmbreeScene& geometry, const std::vector<Mirror>& mirrors, double frequency,
                     const Vec3& polarization)
    : geometry_(geometry), mirrors_(mirrors), polarization_(polarization) {
  for (const Mirror& mirror : mirrors) models_.emplace_back(*mirror.material, frequency);
}

AntennaView view_of(const Vec3& antenna, std::span<const MirrorFrustum> frusta) {
  return {antenna, frusta, FrustumLocator(frusta, kRim)};
}

void LegFinder::find(const LegQuery& query, const AntennaView& antenna, std::vector<Leg>& legs, LegSearch& search) const {
  legs.clear();
  search.segments.clear();
  if (query.skip != kNoMirrors && query.direct != ShadowState::kBlocked) add_direct(query, antenna, legs, search);
  const size_t num_known = search.segments.empty() ? legs.size() : 0;
  for (const int index : antenna.locator.near(query.point)) {
    const MirrorFrustum& frustum = antenna.frusta[index];
    if (static_cast<int>(frustum.mirrors.size()) > query.max_mirrors) break;
    if (frustum.sequence != query.skip) add_over_mirrors(query, antenna, frustum, legs, search);
  }
  if (!search.segments.empty()) keep_open(num_known, legs, search);
}

void LegFinder::add_direct(const LegQuery& query, const AntennaView& antenna, std::vector<Leg>& legs,
                           LegSearch& search) const {
  const Vec3 line = antenna.position - query.point;
  if (!query.faces_all && query.normal.dot(line) <= 0) return;
  if (query.direct == ShadowState::kUnknown) {
    search.segments.push_back({geometry_.lifted(query.point, query.normal), antenna.position});
  }
  Leg& leg = legs.emplace_back();
  leg.length = line.norm();
  leg.to_antenna = (1.0 / leg.length) * line;
  leg.at_antenna = -leg.to_antenna;
}

void LegFinder::add_over_mirrors(const LegQuery& query, const AntennaView& antenna, const MirrorFrustum& frustum,
                                 std::vector<Leg>& legs, LegSearch& search) const {
  const Vec3& point = query.point;
  const Vec3 line = frustum.image() - point;
  if (!query.faces_all && query.normal.dot(line) <= 0) return;
  const bool is_on_plane = frustum.lit_normal.dot(point) - frustum.offset < kNoLegWithin;
  if (is_on_plane || !frustum.reaches(point, kRim)) return;
  const size_t num_segments = search.segments.size();
  Leg& leg = legs.emplace_back();
  leg.sequence = frustum.sequence;
  leg.length = line.norm();
  leg.to_antenna = line / leg.length;
  if (set_bounces(point, query.normal, antenna.position, frustum, leg, search.segments)) return;
  legs.pop_back();
  search.segments.resize(num_segments);
}

// Sets the bounces from the point over the mirrors to the antenna. Returns false where the way misses a mirror.
bool LegFinder::set_bounces(const Vec3& point, const Vec3& normal, const Vec3& antenna, const MirrorFrustum& frustum,
                            Leg& leg, std::vector<Segment>& segments) const {
  Vec3 position = point, from = geometry_.lifted(point, normal), met;
  for (size_t k = frustum.mirrors.size(); k-- > 0;) {
    if (!bounce(frustum.mirrors[k], position, frustum.images[k], leg, met)) return false;
    const Vec3 to = geometry_.lifted(met, leg.bounces[leg.num_bounces - 1].normal);
    segments.push_back({from, to});
    position = met;
    from = to;
  }
  segments.push_back({from, antenna});
  leg.at_antenna = (position - antenna).normalized();
  return true;
}

// Adds the bounce of a wave from a point toward an image behind the mirror; `met` is set to the point where they meet.
bool LegFinder::bounce(int index, const Vec3& from, const Vec3& image, Leg& leg, Vec3& met) const {
  const Mirror& mirror = mirrors_[index];
  if (!mirror.lies_between(from, image)) return false;
  const Vec3 on_plane = mirror.met_on_line(from, image);
  const std::optional<Hit> hit = mirror.mesh.locate(on_plane);
  if (!hit || hit_in_front(mirrors_, index, from, on_plane)) return false;
  // The point is moved to the facet itself, which may lie a little beside the plane.
  met = hit_point(geometry_.corners(hit->mesh_id, hit->triangle_id), *hit);
  LegBounce& bounce = leg.bounces[leg.num_bounces++];
  bounce.mirror = index;
  bounce.hit = *hit;
  bounce.direction = (image - from).normalized();
  bounce.normal = mirror.normal_toward(from);
  return true;
}

// Keeps the legs whose ways are free; the first `num_known` are known to be.
void LegFinder::keep_open(size_t num_known, std::vector<Leg>& legs, LegSearch& search) const {
  const size_t count = search.segments.size();
  search.num_queries += static_cast<int64_t>(count);
  search.blocked.resize(count);
  geometry_.occluded(search.segments.data(), count, search.blocked.data());
  const uint8_t* blocked = search.blocked.data();
  size_t num_open = num_known;
  for (size_t i = num_known; i < legs.size(); ++i) {
    const int num_segments = legs[i].num_bounces + 1;
    const bool is_open = std::none_of(blocked, blocked + num_segments, [](uint8_t value) { return value != 0; });
    blocked += num_segments;
    if (!is_open) continue;
    if (num_open != i) legs[num_open] = legs[i];
    Leg& leg = legs[num_open];
    set_gain(leg);
    if (std::norm(leg.gain) > 0) ++num_open;
  }
  legs.resize(num_open);
}

void LegFinder::set_gain(Leg& leg) const {
  for (int k = 0; k < leg.num_bounces; ++k) {
    LegBounce& bounce = leg.bounces[k];
    const SurfaceModel& model = models_[bounce.mirror];
    const SurfaceResponse response = respond_as_mirror(model, polarization_, bounce.direction, bounce.normal);
    leg.gain *= response.gamma * response.coherent;
    bounce.specular_share = response.coherent * response.coherent;
    leg.specular_share *= bounce.specular_share;
  }
}

}  // namespace echopath
