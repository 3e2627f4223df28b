#include "echopath/trace/sbr/ray_walk.h"

#include <algorithm>
#include <utility>

#include "echopath/trace/connect/packet_echoes.h"

namespace echopath {

// Holds the packet, and the ray of it that is followed now.
template <class Weight>
struct RayWalk<Weight>::Scratch {
  FirstHits first;
  typename Weight::Echoes echoes;
  Ray ray;
  SurfaceHit surface;
  HitLegs legs;
  HitFields fields;
};

template <class Weight>
void RayWalk<Weight>::shoot(int64_t begin, int64_t end, PathBlock& block) const {
  thread_local Scratch scratch;
  for (; begin < end; begin += kPacketSize) {
    const int count = static_cast<int>(std::min<int64_t>(kPacketSize, end - begin));
    front_.trace(begin, count, scratch.first, block.statistics);
    if (has_straight_legs_) scratch.echoes.find(scratch.first, context_.settings.receiver);
    for (int lane = 0; lane < count; ++lane) {
      if (scratch.first.arrives[static_cast<size_t>(lane)]) shoot_lane(lane, scratch, block);
    }
  }
  block.statistics.num_queries += std::exchange(scratch.legs.search.num_queries, 0);
}

// Follows a ray from its first hit on. A ray is made only where there is more than a plain hit.
template <class Weight>
void RayWalk<Weight>::shoot_lane(int lane, Scratch& scratch, PathBlock& block) const {
  const auto k = static_cast<size_t>(lane);
  const FirstHits& first = scratch.first;
  block.current_batch = static_cast<uint8_t>(first.places.batches[k]);
  block.current_half = half_of_ray(first.index(lane));
  RayHit met;
  const bool goes_on = first.goes_on[k] && meets(first.lifted[lane], first.out[lane], met, block);
  const bool has_plain_hit = has_straight_legs_ && is_plain(first, lane);
  if (has_plain_hit) add_plain_echoes(lane, scratch, block);
  if (has_plain_hit && !goes_on) return block.end_ray(&first.hits.met[k]);
  start(lane, scratch);
  if (!has_plain_hit) connect(scratch, block);
  if (goes_on && travel(first.sample(lane), met, scratch, block)) follow(scratch, block);
  block.end_ray(scratch.ray.hits.data());
}

template <class Weight>
void RayWalk<Weight>::add_plain_echoes(int lane, const Scratch& scratch, PathBlock& block) const {
  const FirstHits& first = scratch.first;
  const auto k = static_cast<size_t>(lane);
  scratch.echoes.add(first, lane, block);
  const bool shows_image = first.receiver_reach[lane] > 0 && first.coherent[lane] > 0;
  if (shows_image && first.receiver[k] == ShadowState::kOpen) block.add_chain(1);
}

template <class Weight>
void RayWalk<Weight>::start(int lane, Scratch& scratch) const {
  scratch.legs.has_receive = false;
  front_.start(scratch.first, lane, scratch.ray, scratch.surface);
  weight_.launch(scratch.ray);
  arrivals_.record(scratch.ray, scratch.surface);
}

// Follows a ray from the hit where it is.
template <class Weight>
void RayWalk<Weight>::follow(Scratch& scratch, PathBlock& block) const {
  for (RayHit met;;) {
    connect(scratch, block);
    if (scratch.ray.depth == context_.settings.max_bounces) return;
    const ScatterSample sample = scatterer_.sample(scratch.ray, scratch.surface, block.current_batch);
    if (sample.ends || !meets(sample.from, sample.direction, met, block)) return;
    if (!travel(sample, met, scratch, block)) return;
  }
}

template <class Weight>
void RayWalk<Weight>::connect(Scratch& scratch, PathBlock& block) const {
  Connection at{scratch.ray, scratch.surface, scratch.legs, scratch.fields, block};
  connector_.connect(at);
}

template <class Weight>
bool RayWalk<Weight>::meets(const Vec3& from, const Vec3& direction, RayHit& met, PathBlock& block) const {
  ++block.statistics.num_queries;
  const EmbreeScene::Verdict verdict = context_.geometry.intersect_from_surface(from, direction, met);
  if (verdict == EmbreeScene::Verdict::kFalseHit) ++block.statistics.num_false_hits;
  return verdict == EmbreeScene::Verdict::kHit;
}

// Carries the ray from the hit where it is to the one that it meets next.
template <class Weight>
bool RayWalk<Weight>::travel(const ScatterSample& sample, const RayHit& met, Scratch& scratch, PathBlock& block) const {
  Ray& ray = scratch.ray;
  SurfaceHit& surface = scratch.surface;
  if (!scatterer_.leave(ray, surface, sample, scratch.legs)) return false;
  surface.point = met;
  surface.receiver = ShadowState::kUnknown;
  if (!arrivals_.arrive(ray, surface, block.statistics)) return false;
  surface.samples = hit_samples(context_.settings.seed, ray.index, ray.depth);
  return true;
}

template class RayWalk<ScalarWeight>;
template class RayWalk<JonesWeight>;

}  // namespace echopath
