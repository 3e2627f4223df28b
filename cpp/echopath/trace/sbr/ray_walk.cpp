#include "echopath/trace/sbr/ray_walk.h"

#include <algorithm>
#include <utility>

#include "echopath/trace/connect/packet_echoes.h"

namespace echopath {

namespace {

constexpr int kMostSplits = 3;
constexpr uint64_t kBranchOfWalk = uint64_t{1} << 49;  // beyond those of first hits behind sheets (kBranch)

// Returns the index of the k-th branch of a ray, which may have any bits (LaunchPlan::number_of): it is not negative either.
int64_t index_of_branch(int64_t launch_index, uint64_t k) {
  return static_cast<int64_t>((static_cast<uint64_t>(launch_index) + kBranchOfWalk * k) & (~uint64_t{0} >> 1));
}

}  // namespace

// Holds the packet, and the ray of it that is followed now.
template <class Weight>
struct RayWalk<Weight>::Scratch {
  FirstHits first;
  typename Weight::Echoes echoes;
  Ray ray;
  SurfaceHit surface;
  HitLegs legs;
  HitFields fields;
  int64_t launch_index = 0, num_branches = 0;  // of the launch ray that is followed
};

template <class Weight>
void RayWalk<Weight>::shoot(int64_t begin, int64_t end, PathBlock& block) const {
  thread_local Scratch scratch;
  for (; begin < end; begin += kPacketSize) {
    const int count = static_cast<int>(std::min<int64_t>(kPacketSize, end - begin));
    front_.trace(begin, count, scratch.first, block.statistics);
    do {
      if (has_straight_legs_) scratch.echoes.find(scratch.first, context_.settings.receiver);
      for (int lane = 0; lane < count; ++lane) {
        if (scratch.first.arrives[lane]) shoot_lane(lane, scratch, block);
      }
    } while (front_.trace_behind_sheets(scratch.first, block.statistics));
  }
  block.statistics.num_queries += std::exchange(scratch.legs.search.num_queries, 0);
}

// Follows a ray from its first hit on. A ray is made only where there is more than a plain hit. A ray that meets no sheets
// takes the same random numbers among them: where sheets come or go, all others keep their paths.
template <class Weight>
void RayWalk<Weight>::shoot_lane(int lane, Scratch& scratch, PathBlock& block) const {
  const FirstHits& first = scratch.first;
  block.current_batch = static_cast<uint8_t>(first.places.batches[lane]);
  block.current_ray = half_of_ray(first.ray(lane)) | (first.points ? 0 : place_flags(first.ray(lane)));
  scratch.launch_index = first.index(lane);
  scratch.num_branches = 0;
  RayHit met, met_mirrored;
  const bool goes_on = first.goes_on[lane] && meets(first.lifted[lane], first.out[lane], Sees::kAll, met, block);
  const bool is_split =
      first.is_split(lane) && meets(first.lifted[lane], first.mirrored[lane], Sees::kAll, met_mirrored, block);
  const bool has_plain_hit = has_straight_legs_ && is_plain(first, lane);
  if (has_plain_hit) add_plain_echoes(lane, scratch, block);
  if (has_plain_hit && !goes_on && !is_split) return block.end_ray(&first.hits.met[lane]);
  start(lane, scratch);
  if (!has_plain_hit) connect(scratch, block);
  const auto scatter = [&] {
    if (goes_on) go_on(first.sample(lane), met, scratch, block);
  };
  if (is_split) {
    take_beside(scratch, block, scatter);
    go_on(first.mirrored_sample(lane), met_mirrored, scratch, block);
  } else {
    scatter();
  }
  block.end_ray(scratch.ray.hits.data());
}

// Follows the ray that a surface scatters to its end, and goes back to the hit for the one that it mirrors, which keeps its
// place among its neighbours.
template <class Weight>
template <class GoOn>
void RayWalk<Weight>::take_beside(Scratch& scratch, PathBlock& block, const GoOn& scatter) const {
  orders_.weigh_mirror(scratch.ray, scratch.surface, scratch.legs.search.num_queries);  // once for both
  branch(scratch, block, scatter);
}

// Follows a branch of the ray to its end, with random numbers of its own, and goes back to where it left.
template <class Weight>
template <class GoOn>
void RayWalk<Weight>::branch(Scratch& scratch, PathBlock& block, const GoOn& follow_branch) const {
  const Ray ray = scratch.ray;
  const SurfaceHit surface = scratch.surface;
  scratch.ray.index = index_of_branch(scratch.launch_index, ++scratch.num_branches);
  follow_branch();
  block.end_ray(scratch.ray.hits.data());
  scratch.ray = ray;
  scratch.surface = surface;
}

template <class Weight>
void RayWalk<Weight>::add_plain_echoes(int lane, const Scratch& scratch, PathBlock& block) const {
  const FirstHits& first = scratch.first;
  scratch.echoes.add(first, lane, block);
  const bool shows_image = first.receiver_reach[lane] > 0 && first.coherent[lane] > 0;
  if (shows_image && first.receiver[lane] == ShadowState::kOpen) block.add_chain(1);
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
  connect(scratch, block);
  if (scratch.ray.depth == context_.settings.max_bounces) return;
  ScatterSample sample = scatterer_.sample(scratch.ray, scratch.surface, block.current_batch);
  if (sample.ends) return;
  RayHit met;
  if (sample.is_split) {
    if (meets_next(sample, 0.0, scratch, met, block)) {
      take_beside(scratch, block, [&] { go_on(sample, met, scratch, block); });
    }
    sample = scatterer_.mirrored_beside(scratch.ray, scratch.surface, sample);
  }
  if (meets_next(sample, 0.0, scratch, met, block)) go_on(sample, met, scratch, block);
}

template <class Weight>
void RayWalk<Weight>::connect(Scratch& scratch, PathBlock& block) const {
  Connection at{scratch.ray, scratch.surface, scratch.legs, scratch.fields, block};
  connector_.connect(at);
}

template <class Weight>
bool RayWalk<Weight>::meets(const Vec3& from, const Vec3& direction, Sees sees, RayHit& met, PathBlock& block,
                            double begin) const {
  ++block.statistics.num_queries;
  const EmbreeScene::Verdict verdict = context_.geometry.intersect_from_surface(from, direction, met, sees, begin);
  if (verdict == EmbreeScene::Verdict::kFalseHit) ++block.statistics.num_false_hits;
  if (verdict != EmbreeScene::Verdict::kHit) return false;
  context_.surfaces.choose_front_mirror(from, met.position, met.hit);
  return true;
}

template <class Weight>
bool RayWalk<Weight>::arrive(const RayHit& met, Scratch& scratch, PathBlock& block) const {
  Ray& ray = scratch.ray;
  SurfaceHit& surface = scratch.surface;
  surface.point = met;
  surface.receiver = ShadowState::kUnknown;
  if (!arrivals_.arrive(ray, surface, block.statistics)) return false;
  surface.samples = HitSamples();
  if (context_.draws_samples(ray.depth)) surface.samples = hit_samples(context_.settings.seed, ray.index, ray.depth);
  return true;
}

// Has the ray reflected at each sheet on its way, of which `met` may be the first, and carries it on behind the last one.
template <class Weight>
void RayWalk<Weight>::go_on(const ScatterSample& sample, RayHit& met, Scratch& scratch, PathBlock& block) const {
  if (!scatterer_.leave(scratch.ray, scratch.surface, sample, scratch.legs)) return;
  while (context_.geometry.is_sheet(met.hit.mesh_id)) {
    branch(scratch, block, [&] {
      ++scratch.ray.num_splits;
      if (arrive(met, scratch, block)) follow(scratch, block);
    });
    ++scratch.ray.num_splits;
    if (!meets_next(sample, context_.geometry.behind(met.distance, met.reported), scratch, met, block)) return;
  }
  if (arrive(met, scratch, block)) follow(scratch, block);
}

// Finds what the ray meets next: at sheets only while it may still split.
template <class Weight>
bool RayWalk<Weight>::meets_next(const ScatterSample& sample, double begin, Scratch& scratch, RayHit& met,
                                 PathBlock& block) const {
  if (!meets(sample.from, sample.direction, Sees::kAll, met, block, begin)) return false;
  if (scratch.ray.num_splits < kMostSplits || !context_.geometry.is_sheet(met.hit.mesh_id)) return true;
  ++block.statistics.num_unsplit_rays;
  return meets(sample.from, sample.direction, Sees::kOpaque, met, block, begin);
}

template class RayWalk<ScalarWeight>;
template class RayWalk<JonesWeight>;

}  // namespace echopath
