#include "echopath/trace/sbr/packet_front.h"

#include <cmath>

#include "echopath/base/lanes/simd.h"
#include "echopath/trace/sbr/ray_formula.h"

namespace echopath {
namespace {

constexpr int kMostSheetsAhead = 16;  // of the first hit: at further ones, rays only go on

struct Antennas {
  VectorOf<double> transmitter, receiver;
};

// Measures how first hits lie to the antennas.
ECHOPATH_INLINE void see_lanes(FirstHits* first, Antennas at, double lift) {
  ECHOPATH_SIDE_BY_SIDE
  for (int lane = 0; lane < kPacketSize; ++lane) {
    const VectorOf<double> position = first->hits.position.at(lane), normal = first->hits.normal.at(lane);
    const VectorOf<double> to_receiver = at.receiver - position, to_transmitter = at.transmitter - position;
    first->cos_incidence[lane] = -dot(normal, first->directions.at(lane));
    first->cos_receiver[lane] = dot(normal, to_receiver);
    first->near_squared[lane] = ScalarMath::smaller(dot(to_receiver, to_receiver), dot(to_transmitter, to_transmitter));
    first->lifted.set(lane, position + lift * normal);
  }
}

ECHOPATH_INLINE void leave_lanes(FirstHits* first, VectorOf<double> receiver) {
  ECHOPATH_SIDE_BY_SIDE
  for (int lane = 0; lane < kPacketSize; ++lane) {
    const VectorOf<double> normal = first->hits.normal.at(lane);
    const VectorOf<double> specular = mirrored(first->directions.at(lane), normal, first->cos_incidence[lane]);
    const VectorOf<double> to_receiver = receiver - first->hits.position.at(lane);
    first->receiver_reach[lane] = reach_of(to_receiver, specular, first->hits.distance[lane], first->densities[lane]);
    const VectorOf<double> diffuse = over_surface(normal, first->samples.lobe.at(lane));
    first->mirrored.set(lane, specular);
    const double sample = first->samples.lobe_sample[lane], probability = first->specular_probability[lane];
    first->out.x[lane] = sample < probability ? specular.x : diffuse.x;
    first->out.y[lane] = sample < probability ? specular.y : diffuse.y;
    first->out.z[lane] = sample < probability ? specular.z : diffuse.z;
  }
}

}  // namespace

void PacketFront::trace(int64_t begin, int count, FirstHits& first, TraceStatistics& statistics) const {
  first.begin = begin;
  first.count = count;
  first.num_sheets = 0;
  first.points = nullptr;
  if (context_.plan.is_aimed_at_scatterer(begin)) {
    launch_at_points(first);
  } else {
    first.number = context_.plan.number_of(begin);
    launch(first);
  }
  draw_samples(first);
  find_hits(first, nullptr, statistics);
}

// Finds the first hits, or with `begins` (m) those behind there.
void PacketFront::find_hits(FirstHits& first, const LaneValues* begins, TraceStatistics& statistics) const {
  const Sees sees = first.num_sheets < kMostSheetsAhead ? Sees::kAll : Sees::kOpaque;
  context_.geometry.intersect(context_.settings.transmitter, first.directions, first.count, first.hits, sees, begins);
  statistics.num_queries += first.count;
  if (context_.surfaces.has_coplanar()) choose_front_mirrors(first);
  arrive(first, statistics);
  see_receiver(first, statistics);
  run_simd<&leave_lanes>(&first, unpacked(context_.settings.receiver));
  if (context_.surfaces.has_lobes()) leave_along_lobes(first);
}

// Gives hits on mirrors that lie on each other to the front ones.
void PacketFront::choose_front_mirrors(FirstHits& first) const {
  for (int lane = 0; lane < first.count; ++lane) {
    if (first.hits.verdicts[lane] != EmbreeScene::Verdict::kHit) continue;
    context_.surfaces.choose_front_mirror(context_.settings.transmitter, first.hits.position[lane], first.hits.met[lane]);
  }
}

// Gives rays that leave diffusely the directions of lobes other than Lambert's, by the same numbers.
void PacketFront::leave_along_lobes(FirstHits& first) const {
  for (int lane = 0; lane < first.count; ++lane) {
    if (!first.goes_on[lane] || !first.arrives[lane] || first.models[lane]->lobe().is_lambert()) continue;
    if (first.samples.lobe_sample[lane] < first.specular_probability[lane]) continue;
    const Vec3 in = first.directions[lane], normal = first.hits.normal[lane], drawn = first.samples.lobe[lane];
    first.out.set(lane, unpacked(first.models[lane]->lobe().sample(in, normal, numbers_of(drawn))));
  }
}

bool PacketFront::trace_behind_sheets(FirstHits& first, TraceStatistics& statistics) const {
  if (!context_.geometry.has_sheets()) return false;
  LaneValues begins;
  int num_rays = 0;
  for (int lane = 0; lane < kPacketSize; ++lane) {
    const bool is_at_sheet = lane < first.count && first.hits.verdicts[lane] == EmbreeScene::Verdict::kHit &&
                             context_.geometry.is_sheet(first.hits.met[lane].mesh_id);
    begins[lane] = is_at_sheet ? context_.geometry.behind(first.hits.distance[lane], first.hits.reported[lane]) : -1.0;
    num_rays += is_at_sheet;
  }
  if (num_rays == 0) return false;
  if (++first.num_sheets == kMostSheetsAhead) statistics.num_unsplit_rays += num_rays;
  draw_samples(first);
  find_hits(first, &begins, statistics);
  return true;
}

void PacketFront::draw_samples(FirstHits& first) const {
  const uint64_t seed = context_.settings.seed;
  if (!context_.draws_samples(1)) return first.samples.clear();
  if (!first.points) return first.samples.draw(seed, first.index(0), first.count, first.places.batches.data());
  std::array<int64_t, kPacketSize> keys;
  for (int lane = 0; lane < kPacketSize; ++lane) keys[lane] = first.index(std::min(lane, first.count - 1));
  first.samples.draw_by_keys(seed, keys.data(), first.count);
}

void PacketFront::launch(FirstHits& first) const {
  const LaunchPlan& plan = context_.plan;
  LaunchPlan::Places& places = first.places;
  plan.place(first.begin, first.count, places);
  for (LaneRange lanes{0, 0}; lanes.begin < first.count; lanes.begin = lanes.end) {
    const int stratum = places.strata[lanes.begin];
    while (lanes.end < first.count && places.strata[lanes.end] == stratum) ++lanes.end;
    directions_.launch(stratum, places.x, places.y, lanes, first.directions);
    const double density = plan.density(plan.foci.owner(stratum));
    const bool has_foci = plan.foci.has_any(stratum);
    for (int lane = lanes.begin; lane < lanes.end; ++lane) {
      first.densities[lane] = has_foci ? density / plan.foci.rays_of_owner(stratum, first.directions[lane]) : density;
    }
  }
}

void PacketFront::launch_at_points(FirstHits& first) const {
  const LaunchPlan& plan = context_.plan;
  first.points = plan.surface_scatterers.data() + (first.begin - plan.first_point);
  for (int lane = 0; lane < kPacketSize; ++lane) {
    const SurfacePoint& point = first.points[std::min(lane, first.count - 1)];
    first.places.strata[lane] = point.stratum;
    first.places.batches[lane] = static_cast<int>(point.key % plan.batches);
    first.directions.set(lane, unpacked((point.position - context_.settings.transmitter).normalized()));
    first.densities[lane] = plan.default_density[point.stratum];
  }
}

void PacketFront::arrive(FirstHits& first, TraceStatistics& statistics) const {
  const Antennas antennas{unpacked(context_.settings.transmitter), unpacked(context_.settings.receiver)};
  run_simd<&see_lanes>(&first, antennas, context_.geometry.lift());
  for (int lane = 0; lane < kPacketSize; ++lane) {
    const EmbreeScene::Verdict verdict = first.hits.verdicts[lane];
    const bool is_hit = verdict == EmbreeScene::Verdict::kHit, is_grazing = first.cos_incidence[lane] < kGrazing;
    if (verdict == EmbreeScene::Verdict::kFalseHit) ++statistics.num_false_hits;
    if (is_hit && is_grazing) ++statistics.num_grazing;
    first.arrives[lane] = is_hit && !is_grazing && counts(first, lane);
    if (!first.arrives[lane]) continue;
    ++statistics.num_hits;
    find_response(first, lane);
  }
}

// Returns whether the stratum of the ray owns its hit, or the ray passes over a mirror.
bool PacketFront::counts(FirstHits& first, int lane) const {
  if (first.points) return first.is_owned[lane] = meets_point(first, lane);
  const uint32_t mesh = first.hits.met[lane].mesh_id;
  const bool passes_on = context_.is_passed(first.places.strata[lane], mesh);
  first.is_owned[lane] = !passes_on && context_.is_owner(first.places.strata[lane], mesh, kNoMirrors);
  return (first.is_owned[lane] || passes_on) && std::isfinite(first.densities[lane]);  // else foci have it all
}

// Returns whether the ray of a lane meets the point at which it is aimed, on its triangle or on its edge.
bool PacketFront::meets_point(const FirstHits& first, int lane) const {
  const SurfacePoint& point = first.points[lane];
  const Hit& met = first.hits.met[lane];
  if (met.mesh_id != point.on.mesh_id) return false;
  return met.triangle_id == point.on.triangle_id ||
         (first.hits[lane].position - point.position).norm() <= context_.geometry.lift();
}

// Leaves the ray its part of the echo and of the ways on: a ray of a lattice is mirrored, one aimed at a point scattered.
void PacketFront::share_out(FirstHits& first, int lane) const {
  if (!context_.plan.has_surface_scatterers() || !first.is_owned[lane]) return;
  (first.points ? first.coherent : first.diffuse)[lane] = 0.0;
  if (first.goes_both_ways[lane]) first.samples.lobe_sample[lane] = 0.0;
  const bool is_specular = first.samples.lobe_sample[lane] < first.specular_probability[lane];
  first.goes_on[lane] = first.goes_on[lane] && is_specular != (first.points != nullptr);
}

void PacketFront::find_response(FirstHits& first, int lane) const {
  const SurfaceModel& model = context_.surfaces.model(first.hits.met[lane], first.hits.normal[lane]);
  first.models[lane] = &model;
  first.modes[lane] = model.is_constant() ? PolarizationMode::kTe
                                          : mode_along(model, context_.settings.polarization, first.directions[lane],
                                                       first.hits.normal[lane]);
  const SurfaceResponse response = model.respond(first.cos_incidence[lane], first.modes[lane]);
  const LobeProbabilities lobes = first.is_owned[lane] ? context_.probabilities(model, response) : kPassingOn;
  first.set_response(lane, response, lobes);
  first.goes_both_ways[lane] = !first.points && context_.goes_both_ways(model, lobes, 1);
  first.goes_on[lane] = context_.settings.max_bounces > 1 && response.gamma != 0.0;
  share_out(first, lane);
}

// Asks for the shadows of all first hits together, because these lie beside each other. The paths of a mirror's hit need
// more than that.
void PacketFront::see_receiver(FirstHits& first, TraceStatistics& statistics) const {
  LaneFlags asked, blocked;
  for (size_t k = 0; k < kPacketSize; ++k) {
    asked[k] = first.arrives[k] && !first.models[k]->material().mirror && first.cos_receiver.lanes[k] > 0;
    statistics.num_queries += asked[k];
  }
  context_.geometry.occluded(first.lifted, context_.settings.receiver, asked, blocked);
  for (size_t k = 0; k < kPacketSize; ++k) {
    first.receiver[k] = !asked[k] ? ShadowState::kUnknown : blocked[k] ? ShadowState::kBlocked : ShadowState::kOpen;
  }
}

void PacketFront::start(const FirstHits& first, int lane, Ray& ray, SurfaceHit& surface) const {
  std::construct_at(&ray);
  std::construct_at(&surface);
  ray.index = first.index(lane);
  ray.stratum = first.places.strata[lane];
  ray.direction = first.directions[lane];
  ray.launch_direction = first.directions[lane];  // a copy of the other one would wait for its parts to be stored
  ray.is_owned = first.is_owned[lane];
  ray.leg_density = first.densities[lane];
  ray.launch_density = first.points ? ray.leg_density : context_.plan.density(context_.plan.foci.owner(ray.stratum));
  ray.stands_for = ray.launch_density / ray.leg_density;
  if (context_.surfaces.has_smooth()) ray.differential = RayDifferential::from_point(ray.direction);
  surface.point = first.hits[lane];
  surface.receiver = first.receiver[lane];
  surface.samples = first.samples.hit(lane);
  surface.cos_incidence = first.cos_incidence[lane];
  surface.model = first.models[lane];
  surface.mode = first.modes[lane];
  surface.response = first.response(lane);
}

}  // namespace echopath
