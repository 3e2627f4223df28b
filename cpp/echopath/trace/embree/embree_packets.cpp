// Answers the queries of whole packets.
#include <algorithm>

#include "echopath/base/lanes/simd.h"
#include "echopath/trace/embree/embree_device.h"
#include "echopath/trace/embree/embree_trees.h"

namespace echopath {

// Holds the triangles that the rays of a packet met.
struct PacketFacets {
  LaneVectors corner, corner_u, corner_v;  // where (u, v) is (0, 0), (1, 0) and (0, 1)
  LaneValues u, v;
};

struct RayLanes {
  LaneVectors from, direction;
  LaneValues far;  // m; negative where a lane is not in use
};

namespace {

// Lanes whose points are not close to their rays, and lanes that met nothing, must be looked at one by one.
struct ConfirmedLanes {
  EmbreeScene::PacketHits* hits;
  LaneValues* is_close;
};

ECHOPATH_INLINE void confirm_lanes(const PacketFacets* facets, VectorOf<double> from, const LaneVectors* directions,
                                   ConfirmedLanes out) {
  ECHOPATH_SIDE_BY_SIDE
  for (int lane = 0; lane < kPacketSize; ++lane) {
    const VectorOf<double> corner = facets->corner.at(lane), direction = directions->at(lane);
    const Facet facet{corner, facets->corner_u.at(lane) - corner, facets->corner_v.at(lane) - corner};
    const FacetPoint point = point_of(facet, facets->u[lane], facets->v[lane], from, direction);
    out.hits->position.set(lane, point.position);
    out.hits->distance[lane] = point.distance;
    out.hits->normal.set(lane, turned_against(direction, unit_normal(facet)));
    out.hits->stretch[lane] = 1.0;
    (*out.is_close)[lane] = point.lies_on_ray(kRoundedAbsolute, kRoundedRelative) ? 1.0 : 0.0;
  }
}

ECHOPATH_INLINE void move_up_lanes(VectorOf<double> from, const LaneVectors* directions, double reach, RayLanes* rays) {
  ECHOPATH_SIDE_BY_SIDE
  for (int lane = 0; lane < kPacketSize; ++lane) {
    const VectorOf<double> direction = directions->at(lane);
    rays->from.set(lane, from + way_up(from, direction, reach) * direction);
    rays->direction.set(lane, direction);
  }
}

ECHOPATH_INLINE void connect_lanes(const LaneVectors* from, const LaneVectors* to, double shortest, double reach,
                                   RayLanes* rays) {
  ECHOPATH_SIDE_BY_SIDE
  for (int lane = 0; lane < kPacketSize; ++lane) {
    const SegmentRay ray = segment_ray(from->at(lane), to->at(lane), shortest, reach);
    rays->from.set(lane, ray.from);
    rays->direction.set(lane, ray.direction);
    rays->far[lane] = ray.far;
  }
}

ECHOPATH_INLINE void round_lanes(const RayLanes* rays, RTCRay16* out, ValidLanes* valid) {
  ECHOPATH_SIDE_BY_SIDE
  for (int lane = 0; lane < kPacketSize; ++lane) {
    set_ray(*out, lane, rays->from.at(lane), rays->direction.at(lane), static_cast<float>(rays->far[lane]));
  }
  for (int lane = 0; lane < kPacketSize; ++lane) valid->lanes[lane] = rays->far[lane] > 0 ? -1 : 0;
}

ECHOPATH_INLINE void look_lanes(VectorOf<double> from, const LaneVectors* directions, double reach,
                                const EmbreeScene::Stretches* stretches, RayLanes* rays, LaneValues* moved) {
  ECHOPATH_SIDE_BY_SIDE
  for (int lane = 0; lane < kPacketSize; ++lane) {
    const VectorOf<double> direction = directions->at(lane);
    const double up = way_up(from, direction, reach), end = stretches->end[lane];
    rays->from.set(lane, from + up * direction);
    rays->direction.set(lane, direction);
    rays->far[lane] = end > stretches->begin[lane] ? end - up : -1.0;
    (*moved)[lane] = up;
  }
}

bool is_met(const Hit& hit) { return hit.mesh_id != RTC_INVALID_GEOMETRY_ID; }

void take(const RTCHit16& found, std::array<Hit, kPacketSize>& out) {
  for (size_t k = 0; k < kPacketSize; ++k) out[k] = {found.geomID[k], found.primID[k], found.u[k], found.v[k]};
}

}  // namespace

RayHit EmbreeScene::PacketHits::operator[](int lane) const {
  RayHit hit;
  hit.hit = met[lane];
  hit.position = position[lane];
  hit.normal = normal[lane];
  hit.distance = distance[lane];
  hit.reported = reported[lane];
  hit.stretch = stretch[lane];
  hit.is_smooth = is_smooth[lane];
  if (hit.is_smooth) hit.curvature = curvature[lane];
  return hit;
}

void EmbreeScene::PacketHits::set(int lane, const RayHit& hit) {
  met[lane] = hit.hit;
  position.set(lane, unpacked(hit.position));
  normal.set(lane, unpacked(hit.normal));
  distance[lane] = hit.distance;
  stretch[lane] = hit.stretch;
  is_smooth[lane] = hit.is_smooth;
  if (hit.is_smooth) curvature[lane] = hit.curvature;
}

void EmbreeScene::intersect(const Vec3& from, const LaneVectors& directions, int count, PacketHits& out, Sees sees,
                            const LaneValues* begins) const {
  alignas(64) RTCRayHit16 queries;
  ValidLanes valid;
  RayLanes rays;
  run_simd<&move_up_lanes>(unpacked(from), &directions, reach_, &rays);
  for (int lane = 0; lane < kPacketSize; ++lane) {
    rays.far[lane] = lane < count && (!begins || (*begins)[lane] >= 0.0) ? double{kInfinity} : -1.0;
  }
  run_simd<&round_lanes>(&rays, &queries.ray, &valid);
  std::fill_n(queries.ray.mask, kPacketSize, static_cast<uint32_t>(sees));
  for (int lane = 0; begins && lane < kPacketSize; ++lane) {
    const double moved = way_up(unpacked(from), directions.at(lane), reach_);
    queries.ray.tnear[lane] = static_cast<float>(std::max(0.0, (*begins)[lane] - moved));
  }
  forget_hits(queries.hit);
  queries_->intersect(valid, queries, PacketWay::kTogether);
  take(queries.hit, out.met);
  name_hits(out.met);
  for (int lane = 0; has_sheets_ && lane < kPacketSize; ++lane) {
    out.reported[lane] = double{queries.ray.tfar[lane]} + way_up(unpacked(from), directions.at(lane), reach_);
  }
  if (std::ranges::none_of(out.met, is_met)) return out.verdicts.fill(Verdict::kMiss);
  PacketFacets facets;
  LaneValues is_close;
  fetch(out, facets);
  run_simd<&confirm_lanes>(&facets, unpacked(from), &directions, ConfirmedLanes{&out, &is_close});
  for (int lane = 0; lane < kPacketSize; ++lane) {
    out.verdicts[lane] = is_met(out.met[lane]) ? Verdict::kHit : Verdict::kMiss;
    out.is_smooth[lane] = false;
    if (out.verdicts[lane] == Verdict::kMiss || (is_close[lane] > 0 && !surfaces_[out.met[lane].mesh_id].normals)) continue;
    RayHit hit;
    hit.hit = out.met[lane];
    out.verdicts[lane] = confirm(from, directions[lane], hit);
    if (out.verdicts[lane] == Verdict::kHit) out.set(lane, hit);
  }
}

void EmbreeScene::intersect_meshes(const Vec3& from, const LaneVectors& directions, const Stretches& stretches,
                                   uint32_t mask, MeshHits& out) const {
  alignas(64) RTCRayHit16 queries;
  ValidLanes valid;
  RayLanes rays;
  LaneValues moved;
  run_simd<&look_lanes>(unpacked(from), &directions, reach_, &stretches, &rays, &moved);
  run_simd<&round_lanes>(&rays, &queries.ray, &valid);
  for (int lane = 0; lane < kPacketSize; ++lane) {
    queries.ray.tnear[lane] = static_cast<float>(std::max(0.0, stretches.begin[lane] - moved[lane]));
    queries.ray.mask[lane] = mask;
  }
  forget_hits(queries.hit);
  queries_->intersect(valid, queries, PacketWay::kApart);
  for (int lane = 0; lane < kPacketSize; ++lane) {
    const bool is_met = valid.lanes[lane] != 0 && queries.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID;
    out.mesh_id[lane] = is_met ? named(queries.hit.geomID[lane], queries.hit.primID[lane], 0.0f, 0.0f).mesh_id : kNoMesh;
    out.distance[lane] = double{queries.ray.tfar[lane]} + moved[lane];
  }
}

// Names the triangles that Embree means.
void EmbreeScene::name_hits(std::array<Hit, kPacketSize>& met) const {
  if (trees_->names().empty()) return;
  for (Hit& hit : met) {
    if (is_met(hit)) hit = named(hit.mesh_id, hit.triangle_id, hit.u, hit.v);
  }
}

// Reads the triangles that were met, all at the same time. Lanes that met nothing read that of another lane.
void EmbreeScene::fetch(const PacketHits& hits, PacketFacets& facets) const {
  std::array<const Hit*, kPacketSize> met;
  const Hit* any = std::ranges::find_if(hits.met, is_met);
  for (size_t k = 0; k < kPacketSize; ++k) {
    met[k] = is_met(hits.met[k]) ? &hits.met[k] : any;
    __builtin_prefetch(surfaces_[met[k]->mesh_id].triangles + met[k]->triangle_id);
  }
  for (const Hit* hit : met) {
    const Surface& surface = surfaces_[hit->mesh_id];
    for (const uint32_t vertex : surface.triangles[hit->triangle_id]) __builtin_prefetch(surface.vertices + vertex);
  }
  for (int lane = 0; lane < kPacketSize; ++lane) {
    const Hit& hit = *met[lane];
    const Surface& surface = surfaces_[hit.mesh_id];
    const Triangle& triangle = surface.triangles[hit.triangle_id];
    facets.u[lane] = hit.u;
    facets.v[lane] = hit.v;
    facets.corner.set(lane, unpacked(surface.vertices[triangle[0]]));
    facets.corner_u.set(lane, unpacked(surface.vertices[triangle[1]]));
    facets.corner_v.set(lane, unpacked(surface.vertices[triangle[2]]));
  }
}

// Finds which of the segments that are asked about are blocked; a lane with a negative far end is not asked.
void EmbreeScene::ask_segments(const RayLanes& rays, ValidLanes& blocked) const {
  alignas(64) RTCRay16 queries;
  ValidLanes valid;
  run_simd<&round_lanes>(&rays, &queries, &valid);
  queries_->occluded(valid, queries);
  for (int lane = 0; lane < kPacketSize; ++lane) blocked.lanes[lane] = valid.lanes[lane] & (queries.tfar[lane] < 0 ? -1 : 0);
}

void EmbreeScene::occluded(const LaneVectors& from, const Vec3& to, const LaneFlags& asked, LaneFlags& blocked) const {
  blocked.fill(false);
  const auto num_asked = std::ranges::count(asked, true);
  if (num_asked == 0) return;
  if (num_asked == 1) {  // a packet of one would be slower
    const auto lane = static_cast<int>(std::ranges::find(asked, true) - asked.begin());
    blocked[lane] = occluded(from[lane], to);
    return;
  }
  RayLanes rays;
  ValidLanes met;
  LaneVectors ends;
  for (int lane = 0; lane < kPacketSize; ++lane) ends.set(lane, unpacked(to));
  run_simd<&connect_lanes>(&from, &ends, 2.0 * lift_, reach_, &rays);
  for (int lane = 0; lane < kPacketSize; ++lane) rays.far[lane] = asked[lane] ? rays.far[lane] : -1.0;
  ask_segments(rays, met);
  for (int lane = 0; lane < kPacketSize; ++lane) blocked[lane] = met.lanes[lane] != 0;
}

void EmbreeScene::occluded(const Segment* segments, size_t count, uint8_t* blocked) const {
  if (count == 1) {  // a packet of one would be slower
    *blocked = occluded(segments->from, segments->to);
    return;
  }
  RayLanes rays;
  ValidLanes met;
  for (size_t begin = 0; begin < count; begin += kPacketSize) {
    const auto num_lanes = static_cast<int>(std::min<size_t>(kPacketSize, count - begin));
    LaneVectors from{}, to{};  // a lane without length is not asked
    for (int lane = 0; lane < num_lanes; ++lane) {
      from.set(lane, unpacked(segments[begin + static_cast<size_t>(lane)].from));
      to.set(lane, unpacked(segments[begin + static_cast<size_t>(lane)].to));
    }
    run_simd<&connect_lanes>(&from, &to, 2.0 * lift_, reach_, &rays);
    ask_segments(rays, met);
    for (int lane = 0; lane < num_lanes; ++lane) blocked[begin + static_cast<size_t>(lane)] = met.lanes[lane] != 0;
  }
}

}  // namespace echopath
