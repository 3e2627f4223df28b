#include "echopath/replay/evaluate/shared_leg_plan.h"

#include <bit>
#include <cstring>

#include "echopath/replay/factors/path_weight.h"

namespace echopath {
namespace {

constexpr uint64_t pair_key(uint32_t high, uint32_t low) { return uint64_t{high} << 32 | low; }
// Identifies where in its triangle a hit is.
constexpr uint64_t place_key(const Hit& hit) {
  return pair_key(std::bit_cast<uint32_t>(hit.u), std::bit_cast<uint32_t>(hit.v));
}

}  // namespace

void SharedLegPlan::clear() {
  single_bounces.clear();
  points.clear();
  mirrors.clear();
  images.assign(1, {0, kNone});
  legs.clear();
  inner_points.clear();
  inner.clear();
  chains.clear();
  sliding.clear();
  mirror_paths.clear();
  edge_paths.clear();
  lobed_paths.clear();
}

// Lists the hits and events of a path in the order in which it was traced.
struct SharedLegPlanner::TracedHits {
  const Hit* recorded;
  int count;
  uint64_t diffuse_bits;
  bool is_reversed;
  uint16_t stratum;

  int index(int k) const { return is_reversed ? count - 1 - k : k; }
  const Hit& hit(int k) const { return recorded[index(k)]; }
  // Returns the recorded hits of [first, last].
  const Hit* run(int first, int last) const { return recorded + (is_reversed ? index(last) : first); }
  bool is_diffuse(int k) const { return diffuse_bits >> index(k) & 1; }
};

// Holds the indices of the first and the last material point; they are -1 where the path has flagged mirrors alone.
struct SharedLegPlanner::Ends {
  int first = -1, last = -1;
  bool has_specular = false;  // a hit before the last one reflects and is no flagged mirror
};

bool SharedLegPlanner::is_same(const Known& known, const Known& run) {
  return known.count == run.count && known.of_receivers == run.of_receivers &&
         std::memcmp(known.hits, run.hits, static_cast<size_t>(run.count) * sizeof(Hit)) == 0;
}

void SharedLegPlanner::begin(const Paths& paths, const PathPreparer& preparer, SpecularPoints specular,
                             bool with_single_bounces) {
  paths_ = &paths;
  preparer_ = &preparer;
  slides_ = specular != SpecularPoints::kMaterial;
  with_single_bounces_ = with_single_bounces;
}

const SharedLegPlan& SharedLegPlanner::operator()(std::span<const int64_t> indices) {
  clear();
  for (size_t place = 0; place < indices.size(); ++place) {
    if (paths_->flags[indices[place]] & kEdgePath) plan_.edge_paths.push_back({place, indices[place]});
    else if (!add_single_bounce(place, indices[place])) add_chain(place, indices[place]);
    if (preparer_->has_lobe(indices[place])) plan_.lobed_paths.push_back({place, indices[place]});
  }
  return plan_;
}

void SharedLegPlanner::leave_out(const std::vector<uint8_t>& places) {
  std::vector<size_t> place_of(places.size());
  size_t num_left = 0;
  for (size_t place = 0; place < places.size(); ++place) {
    place_of[place] = num_left;
    if (!places[place]) ++num_left;
  }
  const auto close_ranks = [&](auto& some) {
    std::erase_if(some, [&](const auto& path) { return places[path.place] != 0; });
    for (auto& path : some) path.place = place_of[path.place];
  };
  close_ranks(plan_.chains);
  close_ranks(plan_.mirror_paths);
  close_ranks(plan_.edge_paths);
  close_ranks(plan_.lobed_paths);
  for (SharedLegPlan::SingleBounce& bounce : plan_.single_bounces) {
    for (const size_t kind : {0u, 1u}) {
      if (bounce.has_path(kind)) bounce.place[kind] = place_of[bounce.place[kind]];
    }
  }
}

void SharedLegPlanner::clear() {
  plan_.clear();
  last_start_ = last_end_ = {};
  last_hit_ = nullptr;
  straight_.clear();
  leg_over_mirrors_.clear();
  leg_of_.clear();
  for (SegmentIds& ids : inner_of_) ids.clear();
  for (DenseIds* ids : {&mirror_ids_, &image_ids_, &point_ids_, &leg_ids_}) ids->clear();
}

bool SharedLegPlanner::is_image(const TracedHits& hits, int k) const {
  return preparer_->is_image(hits.hit(k).mesh_id, hits.stratum) && !hits.is_diffuse(k);
}

SharedLegPlanner::Ends SharedLegPlanner::ends_of(const TracedHits& hits) const {
  Ends ends;
  for (int k = 0; k < hits.count; ++k) {
    if (is_image(hits, k)) continue;
    ends.has_specular |= ends.last >= 0 && !hits.is_diffuse(ends.last);
    if (ends.first < 0) ends.first = k;
    ends.last = k;
  }
  return ends;
}

bool SharedLegPlanner::is_single_bounce(size_t path) const {
  if (!with_single_bounces_ || paths_->num_bounces[path] != 1 || paths_->is_reversed(path)) return false;
  const uint32_t mesh = paths_->hits_of(static_cast<int64_t>(path))->mesh_id;
  if (!preparer_->is_plane(mesh) || preparer_->may_stretch(mesh)) return false;
  if (paths_->diffuse[path] != 0) return true;
  return !preparer_->is_mirror(mesh) && paths_->is_of_a_ray(path) && !paths_->curved_cell_of(path);
}

// The coherent and the diffuse path of a point follow each other in the record.
bool SharedLegPlanner::add_single_bounce(size_t place, int64_t path) {
  if (!is_single_bounce(path)) return false;
  const Hit* hit = paths_->hits_of(path);
  const size_t kind = paths_->diffuse[path] != 0;
  constexpr int64_t kNone = SharedLegPlan::SingleBounce::kNoPath;
  const bool is_known = !plan_.single_bounces.empty() && plan_.single_bounces.back().hit == hit &&
                        plan_.single_bounces.back().path[kind] == kNone;
  if (!is_known) plan_.single_bounces.push_back({hit, {kNone, kNone}, {0, 0}});
  plan_.single_bounces.back().path[kind] = path;
  plan_.single_bounces.back().place[kind] = place;
  return true;
}

void SharedLegPlanner::add_chain(size_t place, int64_t path) {
  const TracedHits hits{paths_->hits_of(path), paths_->num_bounces[path], paths_->diffuse[path], paths_->is_reversed(path),
                        paths_->stratum[path]};
  const Ends ends = ends_of(hits);
  const std::complex<double> weight = weight_of(*paths_, path);
  if (ends.first < 0) {
    uint32_t image = 0;
    for (int k = 0; k < hits.count; ++k) image = image_in(image, hits.recorded[k]);
    plan_.mirror_paths.push_back({place, path, image, weight});
    return;
  }
  const bool is_coherent = paths_->diffuse[path] == 0;
  plan_.chains.push_back({place, path, start_leg(hits, ends.first), end_leg(hits, ends.last), inner(hits, ends, is_coherent),
                          slide_of(path, ends), hits.is_reversed, is_coherent, weight});
}

uint32_t SharedLegPlanner::slide_of(int64_t path, const Ends& ends) {
  if (!slides_ || !ends.has_specular) return SharedLegPlan::kNone;
  plan_.sliding.push_back(path);
  return static_cast<uint32_t>(plan_.sliding.size() - 1);
}

// A leg is identified by its recorded hits alone: the antenna at which the path begins stands before the first of them, the
// other antenna behind the last.
uint32_t SharedLegPlanner::start_leg(const TracedHits& hits, int first) {
  if (first == 0) return straight_leg(hits.hit(0), hits.is_reversed);
  const Known run{hits.run(0, first), first + 1, hits.is_reversed};
  if (is_same(last_start_, run)) return last_start_.leg;
  uint32_t& known = leg_of_(run.hits, run.count, run.of_receivers);
  if (known == SegmentIds::kNone) {
    uint32_t image = 0;
    for (int k = 0; k < first; ++k) image = image_in(image, hits.hit(k));
    known = leg_over_mirrors(image, hits.hit(first), run.of_receivers);
  }
  last_start_ = run;
  return last_start_.leg = known;
}

uint32_t SharedLegPlanner::end_leg(const TracedHits& hits, int last) {
  if (last == hits.count - 1) return straight_leg(hits.hit(last), !hits.is_reversed);
  const Known run{hits.run(last, hits.count - 1), hits.count - last, !hits.is_reversed};
  if (is_same(last_end_, run)) return last_end_.leg;
  uint32_t& known = leg_of_(run.hits, run.count, run.of_receivers);
  if (known == SegmentIds::kNone) {
    uint32_t image = 0;
    for (int k = hits.count; --k > last;) image = image_in(image, hits.hit(k));
    known = leg_over_mirrors(image, hits.hit(last), run.of_receivers);
  }
  last_end_ = run;
  return last_end_.leg = known;
}

uint32_t SharedLegPlanner::image_in(uint32_t parent, const Hit& hit) {
  Hit plane = hit;
  if (preparer_->is_plane(hit.mesh_id)) plane.u = plane.v = 0.0f;
  const uint32_t mirror = mirror_ids_(pair_key(plane.mesh_id, plane.triangle_id), place_key(plane));
  if (mirror == plan_.mirrors.size()) plan_.mirrors.push_back(plane);
  const uint32_t image = image_ids_(pair_key(parent, mirror)) + 1;
  if (image == plan_.images.size()) plan_.images.push_back({parent, mirror});
  return image;
}

uint32_t SharedLegPlanner::point(const Hit& hit) {
  if (&hit == last_hit_) return last_point_;
  const uint32_t id = point_ids_(pair_key(hit.mesh_id, hit.triangle_id), place_key(hit));
  if (id == plan_.points.size()) {
    plan_.points.push_back(hit);
    straight_.push_back({SharedLegPlan::kNone, SharedLegPlan::kNone});
  }
  last_hit_ = &hit;
  return last_point_ = id;
}

uint32_t SharedLegPlanner::straight_leg(const Hit& hit, bool of_receivers) {
  const uint32_t at = point(hit);
  uint32_t& known = straight_[at][of_receivers];
  if (known == SharedLegPlan::kNone) known = add_leg({0, at, of_receivers});
  return known;
}

uint32_t SharedLegPlanner::leg_over_mirrors(uint32_t image, const Hit& hit, bool of_receivers) {
  const uint32_t at = point(hit), id = leg_ids_(pair_key(image, at), of_receivers);
  if (id == leg_over_mirrors_.size()) leg_over_mirrors_.push_back(add_leg({image, at, of_receivers}));
  return leg_over_mirrors_[id];
}

uint32_t SharedLegPlanner::add_leg(const SharedLegPlan::Leg& leg) {
  plan_.legs.push_back(leg);
  return static_cast<uint32_t>(plan_.legs.size() - 1);
}

// A path with one diffuse hit has an inner part only where its triangle may stretch, because that changes its area.
uint32_t SharedLegPlanner::inner(const TracedHits& hits, const Ends& ends, bool is_coherent) {
  if (ends.first == ends.last && (is_coherent || !preparer_->may_stretch(hits.hit(ends.first).mesh_id)))
    return SharedLegPlan::kNone;
  const int count = ends.last - ends.first + 1;
  SharedLegPlan::Inner found{plan_.inner_points.size(), plan_.inner_points.size() + static_cast<size_t>(count), 0, 0};
  for (int k = ends.first; k <= ends.last; ++k) found.diffuse |= uint64_t{hits.is_diffuse(k)} << (k - ends.first);
  uint32_t& known = inner_of_[hits.is_reversed](hits.run(ends.first, ends.last), count, found.diffuse);
  if (known != SegmentIds::kNone) return known;
  for (int k = ends.first; k <= ends.last; ++k) {
    plan_.inner_points.push_back(point(hits.hit(k)));
    found.image |= uint64_t{is_image(hits, k)} << (k - ends.first);
  }
  plan_.inner.push_back(found);
  return known = static_cast<uint32_t>(plan_.inner.size() - 1);
}

}  // namespace echopath
