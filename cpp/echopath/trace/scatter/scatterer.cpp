#include "echopath/trace/scatter/scatterer.h"

#include <algorithm>

#include "echopath/base/random.h"
#include "echopath/trace/sbr/ray_formula.h"
#include "echopath/trace/sbr/ray_tube.h"
#include "echopath/trace/scatter/scatter_points.h"

namespace echopath {
namespace {

// A ray ends beyond this product of material areas (m^2 each), whose square root is part of the weight, in single precision.
constexpr double kLargestArea = 1e60;

Vec3 mirrored_direction(const Ray& ray, const SurfaceHit& surface) {
  return packed(mirrored(unpacked(ray.direction), unpacked(surface.point.normal), surface.cos_incidence));
}

}  // namespace

template <class Weight>
ScatterSample Scatterer<Weight>::sample(const Ray& ray, const SurfaceHit& surface, int batch) const {
  const SurfaceResponse& response = surface.response;
  const LobeProbabilities lobes = ray.is_owned ? context_.probabilities(*surface.model, response) : kPassingOn;
  ScatterSample sample;
  sample.survival_probability = survival_probability(response, ray.coherent ? ray.depth : ray.depth - ray.chain.first);
  sample.ends = surface.samples.survival_sample >= sample.survival_probability || std::norm(response.gamma) == 0;
  if (sample.ends) return sample;
  const bool goes_both_ways = ray.coherent && context_.goes_both_ways(*surface.model, lobes, ray.depth);
  sample.is_specular = surface.samples.lobe_sample < lobes.specular;
  sample.is_split = goes_both_ways && !sample.is_specular;
  sample.lobe_probability = !sample.is_specular ? lobes.diffuse : goes_both_ways ? 1.0 : lobes.specular;
  sample.from = context_.geometry.lifted(surface.point.position, surface.point.normal);
  sample.direction = sample.is_specular ? mirrored_direction(ray, surface) : lobe_direction(ray, surface, batch);
  return sample;
}

template <class Weight>
ScatterSample Scatterer<Weight>::mirrored_beside(const Ray& ray, const SurfaceHit& surface,
                                                 const ScatterSample& scattered) const {
  ScatterSample sample = scattered;
  sample.is_specular = true;
  sample.is_split = false;
  sample.lobe_probability = 1.0;
  sample.direction = mirrored_direction(ray, surface);
  return sample;
}

// Deeper in a chain, neighbouring rays are no longer near each other and are drawn independently.
template <class Weight>
std::array<double, 2> Scatterer<Weight>::lobe_numbers(const Ray& ray, int batch) const {
  const uint64_t seed = context_.settings.seed;
  if (ray.coherent) return scatter_point(seed, batch, ray.index, ray.depth - 1);
  return uniform2(seed, Stream::kBounce, static_cast<uint64_t>(ray.index), static_cast<uint32_t>(ray.depth));
}

// Returns the direction in which the ray leaves its hit diffusely.
template <class Weight>
Vec3 Scatterer<Weight>::lobe_direction(const Ray& ray, const SurfaceHit& surface, int batch) const {
  const std::array<double, 2> numbers = lobe_numbers(ray, batch);
  const DiffuseLobe& lobe = surface.model->lobe();
  if (!lobe.is_lambert()) return lobe.sample(ray.direction, surface.point.normal, numbers);
  return packed(over_surface(unpacked(surface.point.normal), unpacked(cosine_lobe(numbers))));
}

template <class Weight>
bool Scatterer<Weight>::leave(Ray& ray, const SurfaceHit& surface, const ScatterSample& sample, HitLegs& legs) const {
  orders_.weigh_mirror(ray, surface, legs.search.num_queries);
  if (!sample.is_specular && !ray.holds_zones) return false;
  if (sample.is_specular) reflect(ray, surface, sample);
  else scatter(ray, surface, sample, legs);
  ray.direction = sample.direction;
  return std::norm(ray.coefficient) > 0 && ray.area < kLargestArea;
}

template <class Weight>
void Scatterer<Weight>::reflect(Ray& ray, const SurfaceHit& surface, const ScatterSample& sample) const {
  ray.field_factor /= sample.probability();
  if (ray.coherent && context_.surfaces.has_smooth()) reflect_tube(ray, surface);
  weight_.reflect(ray, surface);
  leave_mirror(ray, surface, sample);
  if (!ray.coherent) chains_.reflect(ray, surface, sample);
}

// Takes the bounce into the way of the ray: as part of a leg over flagged mirrors, or as an unflagged mirror.
template <class Weight>
void Scatterer<Weight>::leave_mirror(Ray& ray, const SurfaceHit& surface, const ScatterSample& sample) const {
  const SurfaceResponse& response = surface.response;
  const RayHit& point = surface.point;
  const int mirror = context_.surfaces.mirror(point.hit);
  if (mirror >= 0) {
    ray.coefficient *= mirror_sign(surface.mode, context_.settings.polarization, ray.direction, point.normal);
  }
  ray.coefficient *= response.gamma * response.coherent;
  ray.leg_density *= sample.probability();
  ray.chain_share *= sample.lobe_probability;
  const bool is_leg = mirror >= 0 && ray.sequence != kOther && ray.depth <= kMaxLegMirrors;
  ray.sequence = is_leg ? extended(ray.sequence, mirror, context_.mirrors.size()) : kOther;
  if (is_leg) ray.is_owned = false;  // what is met next may have another owner
  if (mirror >= 0) return;
  ++ray.num_mirrors;
  ray.is_mirror_unweighed = true;
  ray.mirror = point;
  ray.mirror_arrival = ray.direction;
  ray.mirror_length = ray.leg_length;
}

template <class Weight>
void Scatterer<Weight>::scatter(Ray& ray, const SurfaceHit& surface, const ScatterSample& sample, HitLegs& legs) const {
  if (ray.coherent) begin_chain(ray, surface, sample, legs);
  ray.coefficient *= diffuse_coefficient(surface.response);
  ray.area *= surface.area;
  ray.diffuse |= uint64_t{1} << (ray.depth - 1);
  ray.coherent = false;
  ray.sequence = kOther;
  ray.num_mirrors = 0;
  chains_.scatter(ray, surface, sample);
  weight_.scatter(ray, surface, sample.direction);
  ray.leg_length = 0.0;
  ray.leg_density = sample.probability() * std::max(surface.point.normal.dot(sample.direction), 1e-9) / kPi *
                    density_over_lambert(surface, ray.direction, sample.direction);
}

template <class Weight>
void Scatterer<Weight>::begin_chain(Ray& ray, const SurfaceHit& surface, const ScatterSample& sample, HitLegs& legs) const {
  if (!legs.has_receive && ray.sequence != kOther) legs_.find_receive(surface, ray.depth - 1, legs);
  chains_.begin(ray, surface, sample, legs.receive);
  weight_.begin_chain(ray);
}

template class Scatterer<ScalarWeight>;
template class Scatterer<JonesWeight>;

}  // namespace echopath
