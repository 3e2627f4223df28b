#include <algorithm>
#include <cmath>
#include <utility>

#include "echopath/base/constants.h"
#include "echopath/trace/sbr_state.h"

namespace echopath {

RayShooter::RayShooter(const Scene& scene, const EmbreeScene& geometry, const std::vector<Mirror>& mirrors,
                       const LaunchPlan& plan, const SbrSettings& settings)
    : scene_(scene), geometry_(geometry), mirrors_(mirrors), plan_(plan), directions_(plan.strata), settings_(settings),
      legs_(geometry, mirrors, settings.frequency, settings.polarization),
      transmitter_(legs_.view_of(settings.transmitter, std::min(kMaxLegMirrors, settings.max_bounces - 1))),
      receiver_(legs_.view_of(settings.receiver, std::min(kMaxLegMirrors, settings.max_bounces - 1))),
      mirror_of_mesh_(scene.meshes().size(), -1),
      wavelength_(kSpeedOfLight / settings.frequency) {
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) mesh_width_.push_back(width_of_smooth(id));
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) models_.emplace_back(*scene.node_of(id).material, settings.frequency);
  for (const SurfaceModel& model : models_) constant_odds_.push_back(odds_of(model, model.constant()));
  for (const Node& node : scene.nodes()) has_smooth_ = has_smooth_ || (node.mesh && node.smooth && !node.material->mirror);
  has_only_direct_legs_ = transmitter_.beams.empty() && receiver_.beams.empty();
  for (size_t i = 0; i < mirrors.size(); ++i) mirror_of_mesh_[mirrors[i].mesh_id] = static_cast<int>(i);
}

void RayShooter::shoot(int64_t begin, int64_t end, PathBlock& block) const {
  thread_local Scratch scratch;
  thread_local Packet packet;
  for (; begin < end; begin += kPacketSize) {
    packet.begin = begin;
    packet.count = static_cast<int>(std::min<int64_t>(kPacketSize, end - begin));
    shoot_packet(packet, scratch, block);
  }
  block.statistics.num_queries += std::exchange(scratch.search.num_queries, 0);
}

// From its hit of `surface` on.
void RayShooter::follow(Ray& ray, Surface& surface, Scratch& scratch, PathBlock& block) const {
  for (RayHit met;;) {
    connect(ray, surface, scratch, block);
    if (ray.depth == settings_.max_bounces) return;
    const ScatterSample sample = scatter(ray, surface, scratch.chain, block.current_batch);
    if (sample.ends || ask(sample.from, sample.direction, met, block) != EmbreeScene::Verdict::kHit) return;
    if (!travel(ray, sample, met, surface, scratch, block)) return;
  }
}

EmbreeScene::Verdict RayShooter::ask(const Vec3& from, const Vec3& direction, RayHit& met, PathBlock& block) const {
  ++block.statistics.num_queries;
  const EmbreeScene::Verdict verdict = geometry_.intersect_from_surface(from, direction, met);
  if (verdict == EmbreeScene::Verdict::kFalseHit) ++block.statistics.num_false_hits;
  return verdict;
}

// From the hit of `surface` to the one that is met next. What the bounce makes of a ray is worked out only then: most meet
// nothing.
bool RayShooter::travel(Ray& ray, const ScatterSample& sample, const RayHit& met, Surface& surface, Scratch& scratch,
                        PathBlock& block) const {
  if (!bounce(ray, surface, sample, scratch)) return false;
  surface.point = met;
  surface.receiver = ShadowState::kUnknown;
  if (!arrive(ray, surface, scratch, block)) return false;
  surface.chance = hit_samples(settings_.seed, ray.index, ray.depth);
  return true;
}

// Whether the rays of a stratum count what first hits on a mesh over these mirrors send.
bool RayShooter::is_owner(int stratum, uint32_t mesh_id, MirrorSequence sequence) const {
  return plan_.owners.owner(mesh_id, sequence) == plan_.foci.owner(stratum);
}

// Whether they are on their way to what they aim at when they meet this mesh.
bool RayShooter::passes(int stratum, uint32_t mesh_id) const {
  return mirror_of_mesh_[mesh_id] >= 0 && !plan_.is_field_of_view(stratum);
}

// At the point of `surface`, if it counts as a hit.
bool RayShooter::arrive(Ray& ray, Surface& surface, const Scratch& scratch, PathBlock& block) const {
  surface.cos_incidence = -surface.point.normal.dot(ray.direction);
  if (surface.cos_incidence < kGrazing) {
    ++block.statistics.num_grazing;
    return false;
  }
  surface.model = &models_[surface.point.hit.mesh_id];
  surface.mode = mode_along(*surface.model, settings_.polarization, ray.direction, surface.point.normal);
  surface.response = surface.model->respond(surface.cos_incidence, surface.mode);
  if (ray.last_was_mirror) look_at_mirror(ray, surface, scratch, block);
  const bool has_field = ray.coherent && surface.response.coherent > 0;
  if (!ray.holds_zones && !has_field) {
    ++block.statistics.num_small_mirrors;
    return false;
  }
  if (!ray.is_owned) {
    const uint32_t mesh = surface.point.hit.mesh_id;
    const bool passes_on = passes(ray.stratum, mesh) && ray.sequence != kOther && ray.depth < kMaxLegMirrors;
    ray.is_owned = !passes_on && is_owner(ray.stratum, mesh, ray.sequence);
    if (!passes_on && !ray.is_owned) return false;
  }
  ++block.statistics.num_hits;
  record_hit(ray, surface);
  return true;
}

// At a hit whose response is known.
void RayShooter::record_hit(Ray& ray, Surface& surface) const {
  surface.material = &surface.model->material();
  ray.hits[static_cast<size_t>(ray.depth++)] = surface.point.hit;
  ray.leg_length += surface.point.distance;
  if (has_smooth_ && ray.coherent) follow_tube(ray, surface);
  if (!surface.material->mirror) {
    ray.has_dielectric_tm |= surface.mode == PolarizationMode::kTm;
    ray.has_odd_conductors ^= !surface.model->is_dielectric();
  }
  surface.area = ray.leg_length * ray.leg_length / (ray.leg_density * surface.cos_incidence);
}

// Carries the ray tube to the surface; caustics on the way turn the phase of the field.
void RayShooter::follow_tube(Ray& ray, Surface& surface) const {
  const double distance = surface.point.distance;
  if (ray.is_curved) {
    for (int n = ray.rays.num_caustics(ray.direction, distance); n > 0; --n) ray.field_factor *= std::complex<double>(0.0, 1.0);
    // Geometrical optics is singular at a caustic: no tube is narrower than the wave allows.
    surface.tube_area = std::max(std::abs(ray.rays.area(ray.direction, distance)), wavelength_ * ray.leg_length);
  }
  ray.rays.transfer(ray.direction, distance, surface.point.normal);
}

}  // namespace echopath
