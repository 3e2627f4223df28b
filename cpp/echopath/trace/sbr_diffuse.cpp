// Chains of several diffuse hits: both orders of each, found by rays from either end.
//
// A ray goes from the transmitter over a leg c (direct, over mirrors) to its first diffuse hit and on to its last one. Over
// every leg c' of that one it gives the paths (c, chain, c') and (c', opposite chain, c): one random phase, coefficients of
// their own. Rays that come over c' and end at c meet the same two paths; the material area counts both kinds.
// Geometry drops out of the odds between the kinds: from x to y rays have the density cos_x cos_y/(pi r^2) per m^2 both
// ways. What remains is how they start and with which probabilities they go on.
// Over a transmit leg that is no leg of a LegFinder (many bounces, unflagged surfaces) no ray comes the opposite way.
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/trace/sbr_state.h"

namespace echopath {
namespace {

const Leg* leg_over(const std::vector<Leg>& legs, MirrorSequence sequence) {
  for (const Leg& leg : legs) {
    if (leg.sequence == sequence) return &leg;
  }
  return nullptr;
}

// The transmit leg of a ray, over whatever it is, as its way back; its hits stay those of the ray.
void set_own_way_back(const Vec3& arrival, const Vec3& departure, std::complex<double> gain, Leg& leg) {
  leg.sequence = kOther;
  leg.to_antenna = -arrival;
  leg.at_antenna = departure;
  leg.gain = gain;
}

}  // namespace

// What the surface makes of a wave that comes from where `direction` points, a unit vector.
SurfaceResponse RayShooter::response_toward(const Surface& surface, const Vec3& direction) const {
  return respond_along(*surface.model, settings_.polarization, -direction, surface.point.normal);
}

// Before a coherent ray leaves a surface diffusely, with the given probability.
void RayShooter::begin_chain(const Ray& ray, const Surface& surface, double probability, Scratch& scratch) const {
  Chain& chain = scratch.chain;
  chain.begin(ray.depth - 1);
  chain.density = probability * ray.stands_for / surface.area;
  if (ray.sequence == kOther) {
    chain.odds = 0.0;
    chain.back.emplace();
    set_own_way_back(ray.direction, ray.launch_direction, ray.coefficient, *chain.back);
    chain.fields = ray.polarized;
    return;
  }
  if (!scratch.has_receive) {
    legs_.find(legs_from(surface, ray.depth - 1, kOther), receiver_, scratch.receive, scratch.search);
  }
  const Leg* back = leg_over(scratch.receive, ray.sequence);
  if (!back) return;
  chain.back = *back;
  if (settings_.is_polarized) chain.fields = incident_over(*back);
}

// Before a ray leaves a hit of its chain diffusely along `out`, with the given probability.
void RayShooter::leave_diffuse(const Ray& ray, const Surface& surface, const Vec3& out, double probability,
                               Chain& chain) const {
  const bool is_first = ray.depth - 1 == chain.first;
  const SurfaceResponse response = response_toward(surface, out);
  chain.coefficient *= diffuse_coefficient(response);
  if (settings_.is_polarized && chain.back) {
    const Vec3 in = is_first ? Vec3(-chain.back->to_antenna) : ray.direction;
    chain.fields = scattered_back(surface, chain.fields, in, out);
  }
  if (surface.point.normal.dot(out) < kGrazing) chain.odds = 0.0;  // the opposite ray would be dropped
  if (is_first) return;
  chain.odds *= chain.held * odds_of(*surface.model, response).diffuse / probability;
  chain.held = survival_of(response, kRouletteBounce);
}

// As a ray leaves a hit of its chain specularly, with the given probability.
void RayShooter::leave_specular(const Ray& ray, const Surface& surface, double probability, Chain& chain) const {
  const SurfaceResponse& response = surface.response;
  chain.coefficient *= response.gamma * response.coherent;
  chain.odds *= chain.held * odds_of(*surface.model, response).specular / probability;
  chain.held = survival_of(response, kRouletteBounce);
  // Of several bounces in a row, whether unflagged surfaces are large enough is judged differently in the other order, which
  // is left to its own rays.
  const bool is_second = !(ray.diffuse >> (ray.depth - 2) & 1);
  if (!is_second || ray.num_mirrors == 0) return;
  chain.odds = 0.0;
  chain.back.reset();
}

// The visible transmit legs of a hit that rays can come over, but for `skip`.
void RayShooter::find_transmit_legs(const Surface& surface, int max_mirrors, MirrorSequence skip, Scratch& scratch) const {
  scratch.transmit.clear();
  if (skip == kDirect && transmitter_.beams.empty()) return;
  LegQuery query = legs_from(surface, max_mirrors, skip);
  query.direct = ShadowState::kUnknown;
  legs_.find(query, transmitter_, scratch.transmit, scratch.search);
  std::erase_if(scratch.transmit, [&](const Leg& leg) { return surface.point.normal.dot(leg.to_antenna) < kGrazing; });
}

// The part of this ray's kind in all rays that meet its chain and `leg` behind it. `response`: of the last hit, to a wave
// that comes over that leg.
double RayShooter::share_of_order(const Surface& surface, const SurfaceResponse& response, const Leg& leg,
                                  const Chain& chain) const {
  if (chain.odds == 0) return 1.0;
  const double density = density_over(surface.point.hit.mesh_id, leg) * surface.point.normal.dot(leg.to_antenna) /
                         (leg.length * leg.length);
  const double probability = odds_of(*surface.model, response).diffuse * survival_of(response, leg.num_bounces + 1);
  return 1.0 / (1.0 + chain.odds * density * probability / chain.density);
}

void RayShooter::connect_chain(const Ray& ray, const Surface& surface, Scratch& scratch, PathBlock& block) const {
  const Chain& chain = scratch.chain;
  if (scratch.receive.empty() && !chain.back) return;
  scratch.transmit.clear();
  if (chain.back || chain.odds > 0) find_transmit_legs(surface, settings_.max_bounces - ray.depth, kOther, scratch);
  const uint64_t bits = ray.diffuse | uint64_t{1} << (ray.depth - 1);
  const std::complex<double> common = std::sqrt(ray.area * surface.area) * surface.chance.phase;
  const auto weighted = [&](std::complex<double> scalar) { return settings_.is_polarized ? common : common * scalar; };
  const std::complex<double> natural = ray.coefficient * diffuse_coefficient(surface.response);
  for (const Leg& in : scratch.transmit) {
    const SurfaceResponse response = response_toward(surface, in.to_antenna);
    const double share = std::sqrt(share_of_order(surface, response, in, chain));
    const Leg* out = leg_over(scratch.receive, in.sequence);
    if (out) record(ray, surface, *out, bits, share * weighted(natural * out->gain), OrderShares{}, scratch, block);
    if (!chain.back) continue;
    const std::complex<double> reversed = in.gain * diffuse_coefficient(response) * chain.coefficient * chain.back->gain;
    record_reversed(ray, chain, in, bits, share * weighted(reversed), block);
    if (settings_.is_polarized) block.set_jones(opposite_matrix(ray, surface, in, chain));
  }
  for (const Leg& out : scratch.receive) {
    if (leg_over(scratch.transmit, out.sequence)) continue;
    record(ray, surface, out, bits, weighted(natural * out.gain), OrderShares{}, scratch, block);
  }
}

// From the transmitter over `leg` to the hit where the ray is, and back along its chain to the receiver.
void RayShooter::record_reversed(const Ray& ray, const Chain& chain, const Leg& leg, uint64_t bits,
                                 std::complex<double> weight, PathBlock& block) const {
  RayHits hits;
  std::copy_n(ray.hits.begin(), ray.depth, hits.begin());
  for (int k = 0; k < chain.back->num_bounces; ++k) {
    hits[static_cast<size_t>(chain.first - 1 - k)] = chain.back->bounces[static_cast<size_t>(k)].hit;
  }
  int count = ray.depth;
  for (int k = 0; k < leg.num_bounces; ++k) hits[static_cast<size_t>(count++)] = leg.bounces[static_cast<size_t>(k)].hit;
  block.add_reversal(hits.data(), count, bits, std::complex<float>(weight), ray.stratum);
}

}  // namespace echopath
