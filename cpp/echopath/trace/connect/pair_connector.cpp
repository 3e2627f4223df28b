#include "echopath/trace/connect/pair_connector.h"

#include <cmath>

namespace echopath {

template <class Weight>
void PairConnector<Weight>::connect(Connection& at) const {
  const std::vector<Leg>& receive = at.legs.receive;
  legs_.find_transmit(at.surface, context_.settings.max_bounces - 1, at.ray.sequence, at.legs);
  if (is_left_to_points(at)) return;
  const std::complex<double> weight = std::sqrt(material_area(at)) * at.surface.samples.phase;
  if (!at.legs.transmit.empty() || receive.size() > 1 || receive[0].num_bounces > 0) return write_fan(at, weight);
  const std::complex<double> own =
      weight * weight_.held(diffuse_coefficient(at.surface.response)) * weight_.held(at.ray.coefficient);
  writer_.write(at, receive[0], last_bit(at.ray), own, OrderShares{});
}

// Returns whether rays that are aimed at points make all pairs of this place, because they see it. Places that only mirrors
// show are left to the other rays.
template <class Weight>
bool PairConnector<Weight>::is_left_to_points(const Connection& at) const {
  return context_.plan.has_surface_scatterers() && at.ray.sequence != kNoMirrors && leg_over(at.legs.transmit, kNoMirrors);
}

// Returns the balance weight: one over the number of hits per m^2 that all visible transmit legs together make here,
// including the ray's own way, times the number of rays that this ray stands for.
template <class Weight>
double PairConnector<Weight>::material_area(const Connection& at) const {
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
void PairConnector<Weight>::write_fan(Connection& at, std::complex<double> weight) const {
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

template class PairConnector<ScalarWeight>;
template class PairConnector<JonesWeight>;

}  // namespace echopath
