#include "echopath/trace/connect/connector.h"

#include <cmath>

#include "echopath/base/plane.h"
#include "echopath/record/near_antenna.h"
#include "echopath/trace/sbr/ray_formula.h"

namespace echopath {

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
  if (!ray.coherent) chains_.connect(at);
  else if (is_in_pairs) pairs_.connect(at);
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
    writer_.write(at, leg, 0, weight * weight_.held(leg.gain), shares);
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
    writer_.write(at, leg, last_bit(at.ray), weight * weight_.held(leg.gain), shares);
  }
}

template class Connector<ScalarWeight>;
template class Connector<JonesWeight>;

}  // namespace echopath
