#include "echopath/trace/connect/connector.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/plane.h"
#include "echopath/record/near_antenna.h"
#include "echopath/trace/sbr/ray_formula.h"
#include "echopath/trace/sbr/ray_tube.h"

namespace echopath {
namespace {

// Returns the bit of the hit where a ray is, in PathRow::diffuse.
uint64_t last_bit(const Ray& ray) { return uint64_t{1} << (ray.depth - 1); }

// Returns the hits of a ray and then those of a receive leg.
RayHits hits_over(const Ray& ray, const Leg& leg) {
  RayHits hits;
  std::copy_n(ray.hits.begin(), ray.depth, hits.begin());
  for (int k = 0; k < leg.num_bounces; ++k) {
    hits[ray.depth + k] = leg.bounces[k].hit;
  }
  return hits;
}

// Returns the same hits, with the way back of the ray's chain in place of its transmit leg.
RayHits hits_back_over(const Ray& ray, const Leg& leg) {
  const DiffuseChain& chain = ray.chain;
  RayHits hits = hits_over(ray, leg);
  for (int k = 0; k < chain.back->num_bounces; ++k) {
    hits[chain.first - 1 - k] = chain.back->bounces[k].hit;
  }
  return hits;
}

}  // namespace

template <class Weight>
bool Connector<Weight>::is_near_antenna(const Vec3& point) const {
  const auto is_near = [&](const Vec3& antenna) { return !reaches_antenna_by_square((point - antenna).squaredNorm()); };
  return is_near(context_.settings.receiver) || is_near(context_.settings.transmitter);
}

template <class Weight>
void Connector<Weight>::connect(Connection& at) const {
  Ray& ray = at.ray;
  const SurfaceHit& surface = at.surface;
  at.legs.receive.clear();
  at.legs.has_receive = false;
  if (!ray.is_owned) return;
  if (context_.settings.finds_edges) show_lit_plane(at);
  if (is_near_antenna(surface.point.position)) {
    ++at.block.statistics.num_near_antenna;
    return;
  }
  const bool radiates_field = ray.coherent && !surface.material->mirror && surface.response.coherent > 0;
  const bool scatters = surface.response.diffuse > 0;
  if (!radiates_field && !scatters) return;
  const bool is_in_pairs = ray.coherent && ray.sequence != kOther && scatters;
  // Pairs need the receive legs for all transmit legs, some of which are shorter than the ray's own.
  legs_.find_receive(surface, context_.settings.max_bounces - (is_in_pairs ? 1 : ray.depth), at.legs);
  if (at.legs.receive.empty() && ray.coherent) return;
  orders_.weigh_mirror(ray, surface, at.block.statistics.num_queries);
  const bool radiates_power = scatters && ray.holds_zones;
  if (!radiates_field && !radiates_power) return;
  weight_.find_receive_axes(at);
  if (radiates_field) {
    connect_coherent(at);
    show_image(at);
  }
  if (!radiates_power) return;
  if (!ray.coherent) connect_chain(at);
  else if (is_in_pairs) connect_pairs(at);
  else connect_diffuse(at);
}

template <class Weight>
void Connector<Weight>::connect_coherent(Connection& at) const {
  const Ray& ray = at.ray;
  const SurfaceHit& surface = at.surface;
  // The field holds 1/q for each bounce, but the area of the launch must not: hence the density without the probabilities.
  const double tube_area = ray.is_curved ? surface.tube_area : ray.leg_length * ray.leg_length;
  const double launch_area =
      ray.stands_for * tube_area / (ray.launch_density * surface.cos_incidence) * surface.point.stretch;
  const std::complex<double> coefficient =
      ray.coefficient * surface.response.gamma * surface.response.coherent * ray.return_sign.value();
  const std::complex<double> weight =
      std::complex<double>(0.0, 1.0) * ray.field_factor * weight_.held(coefficient) * launch_area;
  for (const Leg& leg : at.legs.receive) {
    const OrderShares shares =
        ray.num_mirrors > 0 ? orders_.shares(ray, surface, leg, at.block.statistics.num_queries) : OrderShares{};
    write(at, leg, 0, weight * weight_.held(leg.gain), shares);
  }
}

// Notes the planes over which a coherent ray came to a plane, none of them flagged.
template <class Weight>
void Connector<Weight>::show_lit_plane(Connection& at) const {
  const Ray& ray = at.ray;
  const bool is_over_planes = ray.coherent && ray.depth > 1 && ray.num_mirrors + 1 == ray.depth && !ray.is_curved;
  if (!is_over_planes || at.surface.point.is_smooth || at.surface.material->mirror) return;
  at.block.add_lit_chain(ray.depth, std::sqrt(at.surface.area / at.surface.cos_incidence));
}

// Notes the ray's planes where it shows an image of the receiver over unflagged planes alone.
template <class Weight>
void Connector<Weight>::show_image(Connection& at) const {
  const Ray& ray = at.ray;
  const bool is_over_planes = ray.num_mirrors + 1 == ray.depth && !ray.is_curved && !at.surface.point.is_smooth;
  if (!is_over_planes || at.legs.receive.empty() || at.legs.receive.front().num_bounces > 0) return;
  const RayHit& point = at.surface.point;
  const Vec3 direction = mirrored(ray.direction, point.normal), to_receiver = context_.settings.receiver - point.position;
  if (reach_of(unpacked(to_receiver), unpacked(direction), ray.leg_length, ray.leg_density) > 0)
    at.block.add_chain(ray.depth);
}

template <class Weight>
void Connector<Weight>::connect_diffuse(Connection& at) const {
  const SurfaceHit& surface = at.surface;
  const std::complex<double> coefficient = weight_.held(at.ray.coefficient * diffuse_coefficient(surface.response));
  const std::complex<double> weight = coefficient * std::sqrt(surface.area) * surface.samples.phase;
  for (const Leg& leg : at.legs.receive) {
    OrderShares shares;
    if (at.ray.num_mirrors >
        0) {  // the way back comes to the hit over the leg, from the transmitter, and scatters as from there
      const Vec3 straight = (context_.settings.transmitter - surface.point.position).normalized();
      const Vec3& from = leg.num_bounces == 0 ? straight : leg.to_antenna;
      const SurfaceResponse back = response_toward(surface, context_.settings.polarization, from);
      const double there = diffuse_coefficient(surface.response);  // 0 of what absorbs all
      shares.opposite = there > 0.0 ? diffuse_coefficient(back) / there : 0.0;
    }
    write(at, leg, last_bit(at.ray), weight * weight_.held(leg.gain), shares);
  }
}

// Joins a first diffuse hit over all pairs of its visible transmit and receive legs; at least one receive leg has been
// found. The ray came directly or over at most kMaxLegMirrors flagged mirrors. Rays could have found the hit over each of
// its transmit legs, so all pairs have the same balance weight over these ways (Veach 1997). Where rays are aimed at points
// of rough surfaces, these alone make all pairs of a hit that they see.
template <class Weight>
void Connector<Weight>::connect_pairs(Connection& at) const {
  const std::vector<Leg>& receive = at.legs.receive;
  legs_.find_transmit(at.surface, context_.settings.max_bounces - 1, at.ray.sequence, at.legs);
  if (is_left_to_points(at)) return;
  const std::complex<double> weight = std::sqrt(material_area(at)) * at.surface.samples.phase;
  if (!at.legs.transmit.empty() || receive.size() > 1 || receive[0].num_bounces > 0) return write_fan(at, weight);
  const std::complex<double> own =
      weight * weight_.held(diffuse_coefficient(at.surface.response)) * weight_.held(at.ray.coefficient);
  write(at, receive[0], last_bit(at.ray), own, OrderShares{});
}

// Returns whether rays that are aimed at points make all pairs of this place, because they see it. Places that only mirrors
// show are left to the other rays.
template <class Weight>
bool Connector<Weight>::is_left_to_points(const Connection& at) const {
  return context_.plan.has_surface_scatterers() && at.ray.sequence != kNoMirrors && leg_over(at.legs.transmit, kNoMirrors);
}

// Returns the balance weight: one over the number of hits per m^2 that all visible transmit legs together make here,
// including the ray's own way, times the number of rays that this ray stands for.
template <class Weight>
double Connector<Weight>::material_area(const Connection& at) const {
  const Ray& ray = at.ray;
  const SurfaceHit& surface = at.surface;
  double hits_per_area = ray.launch_density * ray.chain_share * surface.cos_incidence / (ray.leg_length * ray.leg_length);
  const bool is_aimed_at_scatterer = context_.plan.has_surface_scatterers() && ray.sequence == kNoMirrors;
  if (is_aimed_at_scatterer) return ray.stands_for / hits_per_area;
  for (const Leg& leg : at.legs.transmit) {
    hits_per_area += density_over(context_.plan, surface.point.hit.mesh_id, leg) * surface.point.normal.dot(leg.to_antenna) /
                     (leg.length * leg.length);
  }
  return ray.stands_for / hits_per_area;
}

template <class Weight>
void Connector<Weight>::write_fan(Connection& at, std::complex<double> weight) const {
  const Ray& ray = at.ray;
  const SurfaceHit& surface = at.surface;
  PathBlock& block = at.block;
  block.begin_fan(surface.point.hit, ray.stratum, context_.settings.max_bounces);
  for (const Leg& in : at.legs.transmit) {
    block.add_leg_in(weight * weight_.held_toward(surface, in.to_antenna) * weight_.held(in.gain));
    for (int k = in.num_bounces; k-- > 0;) block.add_leg_hit(in.bounces[k].hit);
  }
  block.add_leg_in(weight * weight_.held(diffuse_coefficient(surface.response)) * weight_.held(ray.coefficient));
  for (int k = 0; k < ray.depth - 1; ++k) block.add_leg_hit(ray.hits[k]);
  for (const Leg& out : at.legs.receive) {
    block.add_leg_out(weight_.held(out.gain));
    for (int k = 0; k < out.num_bounces; ++k) block.add_leg_hit(out.bounces[k].hit);
  }
  weight_.add_pair_matrices(at);
  block.end_fan();
}

// Joins the last hit of a chain of diffuse hits to the antennas, in both orders of the chain (diffuse_chain.h).
template <class Weight>
void Connector<Weight>::connect_chain(Connection& at) const {
  const Ray& ray = at.ray;
  const SurfaceHit& surface = at.surface;
  const DiffuseChain& chain = ray.chain;
  const std::vector<Leg>&receive = at.legs.receive, &transmit = at.legs.transmit;
  if (receive.empty() && !chain.back) return;
  at.legs.transmit.clear();
  if (chain.back || chain.opposite_ratio > 0) {
    legs_.find_transmit(surface, context_.settings.max_bounces - ray.depth, kOther, at.legs);
  }
  const uint64_t bits = ray.diffuse | last_bit(ray);
  const std::complex<double> common = std::sqrt(ray.area * surface.area) * surface.samples.phase;
  const std::complex<double> natural = ray.coefficient * diffuse_coefficient(surface.response);
  for (const Leg& in : transmit) {
    const SurfaceResponse response = response_toward(surface, context_.settings.polarization, in.to_antenna);
    const double share = std::sqrt(chain_orders_.share(ray, surface, response, in));
    const Leg* out = leg_over(receive, in.sequence);
    if (out) write(at, *out, bits, share * (common * weight_.held(natural * out->gain)), OrderShares{});
    if (!chain.back) continue;
    const std::complex<double> reversed = in.gain * diffuse_coefficient(response) * chain.coefficient * chain.back->gain;
    write_reversed(at, in, bits, share * (common * weight_.held(reversed)));
  }
  for (const Leg& out : receive) {
    if (leg_over(transmit, out.sequence)) continue;
    write(at, out, bits, common * weight_.held(natural * out.gain), OrderShares{});
  }
}

// Writes the path over the ray's own hits and a receive leg, and its reversal, as far as each has a share and not too many
// hits. `diffuse` has a bit for each hit; it is 0 for coherent paths.
template <class Weight>
void Connector<Weight>::write(Connection& at, const Leg& leg, uint64_t diffuse, std::complex<double> weight,
                              const OrderShares& shares) const {
  const Ray& ray = at.ray;
  const int count = ray.depth + leg.num_bounces;
  if (count > context_.settings.max_bounces) return;
  if (shares.own > 0) {
    const std::complex<float> rounded(shares.own * weight);
    if (leg.num_bounces == 0) at.block.add_prefix(ray.depth, diffuse, rounded, ray.stratum);
    else at.block.add(hits_over(ray, leg).data(), count, diffuse, rounded, ray.stratum);
    set_columns(at, leg, diffuse);
  }
  if (shares.opposite == 0) return;
  const std::complex<float> rounded(shares.opposite * weight);
  at.block.add_reversal(hits_over(ray, leg).data(), count, diffuse, rounded, ray.stratum);
  set_columns(at, leg, diffuse);
  weight_.exchange_antennas(at, leg);
}

// Writes the path from the transmitter over `leg` to the hit where the ray is, and back along its chain to the receiver.
template <class Weight>
void Connector<Weight>::write_reversed(Connection& at, const Leg& leg, uint64_t diffuse, std::complex<double> weight) const {
  const Ray& ray = at.ray;
  at.block.add_reversal(hits_back_over(ray, leg).data(), ray.depth + leg.num_bounces, diffuse, std::complex<float>(weight),
                        ray.stratum);
  weight_.set_reversed_matrix(at, leg);
}

// Sets the columns that the last path needs beside its weight, if the scene asks for them.
template <class Weight>
void Connector<Weight>::set_columns(Connection& at, const Leg& leg, uint64_t diffuse) const {
  if (diffuse != 0) return weight_.set_diffuse_matrix(at, leg);
  if (at.ray.is_curved) {
    const Hit& hit = at.surface.point.hit;
    const std::array<Vec3, 3> corners = context_.geometry.corners(hit.mesh_id, hit.triangle_id);
    at.block.set_curved_cell(footprint_of_tube(at.ray, at.surface, corners, context_.plan.lattice_density(at.ray.stratum)));
  }
  weight_.set_coherent_matrix(at, leg);
}

template class Connector<ScalarWeight>;
template class Connector<JonesWeight>;

}  // namespace echopath
