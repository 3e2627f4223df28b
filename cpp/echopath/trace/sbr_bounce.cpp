// How rays go on from a hit.
#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/base/random.h"
#include "echopath/trace/sbr_state.h"
#include "echopath/trace/scatter_points.h"

namespace echopath {
namespace {

static_assert(kMaxLegMirrors < kRouletteBounce, "the balance weight over legs knows of no roulette on mirrors");
// Product of material areas (m^2 each) beyond which a ray ends: its square root is part of the weight, in single precision.
constexpr double kLargestArea = 1e60;

}  // namespace

// The larger reflectivity of both lobes, so that neither gains weight as it survives.
double RayShooter::survival_of(const SurfaceResponse& response, int num_bounces) {
  if (num_bounces < kRouletteBounce) return 1.0;
  const double facet = response.diffuse > 0 ? response.facet * response.facet : 0.0;
  return std::min(1.0, std::max(std::norm(response.gamma), facet));
}

RayShooter::LobeProbabilities RayShooter::odds_of(const SurfaceModel& model, const SurfaceResponse& response) const {
  const LobeProbabilities shares{response.coherent * response.coherent, response.diffuse * response.diffuse};
  const bool is_asked = settings_.specular_probability > 0 && shares.specular > 0 && shares.diffuse > 0;
  // The balance weight over the legs of mirrors (LegFinder) counts on their shares.
  if (!is_asked || model.material().mirror) return shares;
  return {settings_.specular_probability, 1.0 - settings_.specular_probability};
}

RayShooter::ScatterSample RayShooter::scatter(const Ray& ray, const Surface& surface, const Chain& chain, int batch) const {
  const SurfaceResponse& response = surface.response;
  const LobeProbabilities odds = ray.is_owned ? odds_of(*surface.model, response) : kPassingOn;
  ScatterSample sample;
  sample.survival = survival_of(response, ray.coherent ? ray.depth : ray.depth - chain.first);
  sample.ends = surface.chance.survival_coin >= sample.survival || std::norm(response.gamma) == 0;
  if (sample.ends) return sample;
  sample.is_specular = surface.chance.lobe_coin < odds.specular;
  sample.odds = sample.is_specular ? odds.specular : odds.diffuse;
  const Vec3& normal = surface.point.normal;
  sample.from = geometry_.lifted(surface.point.position, normal);
  sample.direction = packed(sample.is_specular ? mirrored(unpacked(normal), unpacked(ray.direction), surface.cos_incidence)
                                         : over_surface(unpacked(normal), unpacked(scatter_lobe(ray, batch))));
  return sample;
}

// What becomes of the ray on its way. False: nothing that counts.
bool RayShooter::bounce(Ray& ray, const Surface& surface, const ScatterSample& sample, Scratch& scratch) const {
  if (!sample.is_specular && !ray.holds_zones) return false;
  if (sample.is_specular) bounce_specular(ray, surface, sample, scratch);
  else bounce_diffuse(ray, surface, sample, scratch);
  ray.direction = sample.direction;
  return std::norm(ray.coefficient) > 0 && ray.area < kLargestArea;
}

void RayShooter::bounce_specular(Ray& ray, const Surface& surface, const ScatterSample& sample, Scratch& scratch) const {
  Chain& chain = scratch.chain;
  const SurfaceResponse& response = surface.response;
  const RayHit& point = surface.point;
  ray.field_factor /= sample.probability();
  if (ray.coherent && has_smooth_) reflect_tube(ray, surface);
  if (settings_.is_polarized) reflect_polarized(ray, surface, ray.polarized);
  if (settings_.is_polarized && !ray.coherent && chain.back) reflect_polarized(ray, surface, chain.fields);
  const int mirror = mirror_of_mesh_[point.hit.mesh_id];
  if (mirror >= 0) {
    ray.coefficient *= mirror_sign(*surface.material, surface.mode, settings_.polarization, ray.direction, point.normal);
  }
  ray.coefficient *= response.gamma * response.coherent;
  ray.leg_density *= sample.probability();
  ray.chain_share *= sample.odds;
  const bool is_leg = mirror >= 0 && ray.sequence != kOther && ray.depth <= kMaxLegMirrors;
  ray.sequence = is_leg ? extended(ray.sequence, mirror, mirrors_.size()) : kOther;
  if (is_leg) ray.is_owned = false;  // what is met next may have another owner
  ray.last_was_mirror = mirror < 0;
  if (mirror < 0) {
    ++ray.num_mirrors;
    scratch.mirror = point;
    scratch.mirror_arrival = ray.direction;
  }
  if (!ray.coherent) leave_specular(ray, surface, sample.probability(), chain);
}

// The tube of a coherent ray, before its direction changes.
void RayShooter::reflect_tube(Ray& ray, const Surface& surface) const {
  const RayHit& point = surface.point;
  const Mat3 flat = Mat3::Zero();
  ray.rays.reflect(ray.direction, point.normal, point.is_smooth ? point.curvature : flat);
  ray.is_curved = ray.is_curved || point.is_smooth;
}

// The direction in which the ray leaves its hit diffusely, the normal along z. Neighbours are neighbours no more deeper in a
// chain.
Vec3 RayShooter::scatter_lobe(const Ray& ray, int batch) const {
  if (ray.coherent) return cosine_lobe(scatter_point(settings_.seed, batch, ray.index, ray.depth - 1));
  const auto index = static_cast<uint64_t>(ray.index);
  return cosine_lobe(uniform2(settings_.seed, Stream::kBounce, index, static_cast<uint32_t>(ray.depth)));
}

void RayShooter::bounce_diffuse(Ray& ray, const Surface& surface, const ScatterSample& sample, Scratch& scratch) const {
  if (ray.coherent) begin_chain(ray, surface, sample.probability(), scratch);
  ray.coefficient *= diffuse_coefficient(surface.response);
  ray.area *= surface.area;
  ray.diffuse |= uint64_t{1} << (ray.depth - 1);
  ray.coherent = false;
  ray.sequence = kOther;
  ray.num_mirrors = 0;
  ray.last_was_mirror = false;
  leave_diffuse(ray, surface, sample.direction, sample.probability(), scratch.chain);
  if (settings_.is_polarized) scatter_polarized(ray, surface, sample.direction);
  ray.leg_length = 0.0;
  ray.leg_density = sample.probability() * std::max(surface.point.normal.dot(sample.direction), 1e-9) / kPi;
}

}  // namespace echopath
