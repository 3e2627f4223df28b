// The queries of a log once more, and nothing else.
#include "echopath/trace/geometry/embree_device.h"

namespace echopath {
namespace {

void ask(RTCScene scene, const QueryLog::Ray& ray, bool is_shadow) {
  RTCRayHit query;
  set_ray(query.ray, ray.from, ray.direction, ray.far);
  if (is_shadow) return embree_occluded(scene, query.ray);
  forget_hit(query.hit);
  embree_intersect(scene, query);
}

void ask(RTCScene scene, const QueryLog::Ray* rays, bool is_shadow) {
  alignas(64) RTCRayHit16 queries;
  ValidLanes valid;
  if (!is_shadow) forget_hits(queries.hit);
  for (int lane = 0; lane < kPacketSize; ++lane) {
    set_ray(queries.ray, lane, rays[lane].from, rays[lane].direction, rays[lane].far);
    valid.lanes[lane] = rays[lane].far > 0 ? -1 : 0;
  }
  if (is_shadow) embree_occluded(scene, valid.lanes, queries.ray);
  else embree_intersect(scene, valid.lanes, queries);
}

}  // namespace

void EmbreeScene::ask_again(const QueryLog& log, QueryLog::Mark begin, QueryLog::Mark end, bool one_by_one) const {
  const QueryLog::Ray* rays = log.rays.data() + begin.ray;
  for (size_t i = begin.call; i < end.call; ++i) {
    const auto [kind, count] = log.calls[i];
    const bool is_shadow = kind == QueryLog::Kind::kShadow || kind == QueryLog::Kind::kShadowPacket;
    const bool is_single = kind == QueryLog::Kind::kClosest || kind == QueryLog::Kind::kShadow;
    if (one_by_one || is_single) {
      for (int k = 0; k < count; ++k) {
        if (rays[k].far > 0) ask(device_->scene, rays[k], is_shadow);
      }
    } else {
      ask(device_->scene, rays, is_shadow);
    }
    rays += count;
  }
}

}  // namespace echopath
