#include "echopath/bench/query_recorder.h"

#include <array>

#include "echopath/trace/embree/embree_device.h"

namespace echopath {
namespace {

using Queries = EmbreeScene::Queries;
using RaysOfPacket = std::array<QueryLog::Ray, kPacketSize>;

QueryLog::Ray ray_of(const RTCRay& ray) {
  return {{ray.org_x, ray.org_y, ray.org_z}, {ray.dir_x, ray.dir_y, ray.dir_z}, ray.tfar};
}

RaysOfPacket rays_of(const RTCRay16& rays, const ValidLanes& valid) {
  RaysOfPacket out;
  for (int lane = 0; lane < kPacketSize; ++lane) {
    out[lane] = {{rays.org_x[lane], rays.org_y[lane], rays.org_z[lane]},
                 {rays.dir_x[lane], rays.dir_y[lane], rays.dir_z[lane]},
                 valid.lanes[lane] ? rays.tfar[lane] : -1.0f};
  }
  return out;
}

void ask(const Queries& queries, const QueryLog::Ray& ray, bool is_shadow) {
  RTCRayHit query;
  set_ray(query.ray, ray.from, ray.direction, ray.far);
  if (is_shadow) return queries.occluded(query.ray);
  forget_hit(query.hit);
  queries.intersect(query);
}

void ask(const Queries& queries, const QueryLog::Ray* rays, bool is_shadow) {
  alignas(64) RTCRayHit16 packet;
  ValidLanes valid;
  if (!is_shadow) forget_hits(packet.hit);
  for (int lane = 0; lane < kPacketSize; ++lane) {
    set_ray(packet.ray, lane, rays[lane].from, rays[lane].direction, rays[lane].far);
    valid.lanes[lane] = rays[lane].far > 0 ? -1 : 0;
  }
  if (is_shadow) queries.occluded(valid, packet.ray);
  else queries.intersect(valid, packet, PacketWay::kTogether);
}

}  // namespace

class QueryRecorder::RecordedQueries final : public EmbreeScene::Queries {
 public:
  RecordedQueries(const Queries& asked, QueryLog& log) : asked_(asked), log_(log) {}

  void intersect(RTCRayHit& query) const override {
    write_down(QueryLog::Kind::kClosest, query.ray);
    asked_.intersect(query);
  }
  void intersect(const ValidLanes& valid, RTCRayHit16& packet, PacketWay way) const override {
    log_.add(QueryLog::Kind::kClosestPacket, rays_of(packet.ray, valid));
    asked_.intersect(valid, packet, way);
  }
  void occluded(RTCRay& ray) const override {
    write_down(QueryLog::Kind::kShadow, ray);
    asked_.occluded(ray);
  }
  void occluded(const ValidLanes& valid, RTCRay16& rays) const override {
    log_.add(QueryLog::Kind::kShadowPacket, rays_of(rays, valid));
    asked_.occluded(valid, rays);
  }

 private:
  void write_down(QueryLog::Kind kind, const RTCRay& ray) const {
    const QueryLog::Ray asked = ray_of(ray);
    log_.add(kind, {&asked, 1});
  }

  const Queries& asked_;
  QueryLog& log_;
};

QueryRecorder::QueryRecorder(EmbreeScene& geometry, QueryLog& log)
    : geometry_(geometry), before_(geometry.queries()), recorded_(std::make_unique<RecordedQueries>(before_, log)) {
  geometry_.ask_through(*recorded_);
}

QueryRecorder::~QueryRecorder() { geometry_.ask_through(before_); }

void ask_again(const EmbreeScene& geometry, const QueryLog& log, QueryLog::Mark begin, QueryLog::Mark end, bool one_by_one) {
  const Queries& queries = geometry.queries();
  const QueryLog::Ray* rays = log.rays.data() + begin.ray;
  for (size_t i = begin.call; i < end.call; ++i) {
    const auto [kind, count] = log.calls[i];
    const bool is_shadow = kind == QueryLog::Kind::kShadow || kind == QueryLog::Kind::kShadowPacket;
    const bool is_single = kind == QueryLog::Kind::kClosest || kind == QueryLog::Kind::kShadow;
    if (one_by_one || is_single) {
      for (int k = 0; k < count; ++k) {
        if (rays[k].far > 0) ask(queries, rays[k], is_shadow);
      }
    } else {
      ask(queries, rays, is_shadow);
    }
    rays += count;
  }
}

}  // namespace echopath
