#include "echopath/trace/connect/diffuse_chain.h"

namespace echopath {
namespace {

// Turns the transmit leg of a ray, whatever mirrors it goes over, into its way back; the hits stay those of the ray.
void set_own_way_back(const Ray& ray, Leg& leg) {
  leg.sequence = kOther;
  leg.to_antenna = -ray.direction;
  leg.at_antenna = ray.launch_direction;
  leg.gain = ray.coefficient;
}

}  // namespace

void DiffuseChainOrders::begin(Ray& ray, const SurfaceHit& surface, const ScatterSample& sample,
                               const std::vector<Leg>& receive) const {
  DiffuseChain& chain = ray.chain;
  chain.first = ray.depth - 1;
  chain.density =
      sample.probability() * ray.stands_for / surface.area * density_over_lambert(surface, ray.direction, sample.direction);
  chain.opposite_ratio = chain.opposite_survival = 1.0;
  chain.coefficient = 1.0;
  chain.back.reset();
  if (ray.sequence == kOther) {
    chain.opposite_ratio = 0.0;
    chain.back.emplace();
    set_own_way_back(ray, *chain.back);
  } else if (const Leg* back = leg_over(receive, ray.sequence)) {
    chain.back = *back;
  }
}

void DiffuseChainOrders::scatter(Ray& ray, const SurfaceHit& surface, const ScatterSample& sample) const {
  DiffuseChain& chain = ray.chain;
  const SurfaceResponse response = response_toward(surface, context_.settings.polarization, sample.direction);
  chain.coefficient *= diffuse_coefficient(response);
  // A ray in the opposite order would be dropped there, because it grazes the surface.
  if (surface.point.normal.dot(sample.direction) < kGrazing) chain.opposite_ratio = 0.0;
  if (ray.depth - 1 == chain.first) return;
  chain.opposite_ratio *=
      chain.opposite_survival * context_.probabilities(*surface.model, response).diffuse / sample.probability();
  chain.opposite_ratio *= density_over_lambert(surface, -sample.direction, -ray.direction) /
                          density_over_lambert(surface, ray.direction, sample.direction);
  chain.opposite_survival = survival_probability(response, kRouletteBounce);
}

void DiffuseChainOrders::reflect(Ray& ray, const SurfaceHit& surface, const ScatterSample& sample) const {
  DiffuseChain& chain = ray.chain;
  const SurfaceResponse& response = surface.response;
  chain.coefficient *= response.gamma * response.coherent;
  chain.opposite_ratio *=
      chain.opposite_survival * context_.probabilities(*surface.model, response).specular / sample.probability();
  chain.opposite_survival = survival_probability(response, kRouletteBounce);
  // After several bounces in a row, the opposite order judges differently whether unflagged surfaces are large enough; it is
  // left to its own rays.
  const bool is_second = !(ray.diffuse >> (ray.depth - 2) & 1);
  if (!is_second || ray.num_mirrors == 0) return;
  chain.opposite_ratio = 0.0;
  chain.back.reset();
}

double DiffuseChainOrders::share(const Ray& ray, const SurfaceHit& surface, const SurfaceResponse& response,
                                 const Leg& leg) const {
  const DiffuseChain& chain = ray.chain;
  if (chain.opposite_ratio == 0) return 1.0;
  const double density = density_over(context_.plan, surface.point.hit.mesh_id, leg) *
                         surface.point.normal.dot(leg.to_antenna) / (leg.length * leg.length);
  const double probability = context_.probabilities(*surface.model, response).diffuse *
                             survival_probability(response, leg.num_bounces + 1) *
                             density_over_lambert(surface, -leg.to_antenna, -ray.direction);
  return 1.0 / (1.0 + chain.opposite_ratio * density * probability / chain.density);
}

}  // namespace echopath
