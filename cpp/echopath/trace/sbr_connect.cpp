// Connections of a hit: to the receiver, to its images, and back to the transmitter.
#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/scene/smooth.h"
#include "echopath/trace/sbr_state.h"

namespace echopath {

// The hits of a ray and then those of a receive leg.
RayShooter::RayHits RayShooter::way_back_over(const Ray& ray, const Leg& leg) {
  RayHits hits;
  std::copy_n(ray.hits.begin(), ray.depth, hits.begin());
  for (int k = 0; k < leg.num_bounces; ++k) {
    hits[static_cast<size_t>(ray.depth + k)] = leg.bounces[static_cast<size_t>(k)].hit;
  }
  return hits;
}

LegQuery RayShooter::legs_from(const Surface& surface, int max_mirrors, MirrorSequence skip) const {
  return {surface.point.position, surface.point.normal, max_mirrors, skip, surface.receiver};
}

void RayShooter::connect(const Ray& ray, const Surface& surface, Scratch& scratch, PathBlock& block) const {
  const Vec3& point = surface.point.position;
  scratch.receive.clear();
  scratch.has_receive = false;
  if (!ray.is_owned) return;
  const auto is_near = [&](const Vec3& antenna) { return (point - antenna).squaredNorm() < kNearAntenna * kNearAntenna; };
  if (is_near(settings_.receiver) || is_near(settings_.transmitter)) {
    ++block.statistics.num_near_antenna;
    return;
  }
  const bool radiates_field = ray.coherent && !surface.material->mirror && surface.response.coherent > 0;
  const bool radiates_power = surface.response.diffuse > 0 && ray.holds_zones;
  if (!radiates_field && !radiates_power) return;
  const bool in_pairs = ray.coherent && ray.sequence != kOther && radiates_power;
  // Pairs need the receive legs for all transmit legs, shorter ones than the ray's own among them.
  legs_.find(legs_from(surface, settings_.max_bounces - (in_pairs ? 1 : ray.depth), kOther), receiver_, scratch.receive,
             scratch.search);
  scratch.has_receive = true;
  if (scratch.receive.empty() && ray.coherent) return;
  if (settings_.is_polarized) find_receive_axes(scratch);
  if (radiates_field) connect_coherent(ray, surface, scratch, block);
  if (!radiates_power) return;
  if (!ray.coherent) connect_chain(ray, surface, scratch, block);
  else if (in_pairs) connect_all_pairs(ray, surface, scratch, block);
  else connect_diffuse(ray, surface, scratch, block);
}

// Fresnel's TM coefficient is that along p_i and p_r (em/fresnel.h), which point opposite ways where a wave turns back, so
// that what comes back to the radar changes its sign once: at normal incidence TE and TM then are the same. Conductors
// count as TE at every angle: an odd number of them has made that change.
void RayShooter::connect_coherent(const Ray& ray, const Surface& surface, const Scratch& scratch, PathBlock& block) const {
  // The field holds 1/q for each bounce, the area of the launch must not: hence the density without the probabilities.
  const double tube_area = ray.is_curved ? surface.tube_area : ray.leg_length * ray.leg_length;
  const double launch_area = ray.stands_for * tube_area / (ray.launch_density * surface.cos_incidence) * surface.point.stretch;
  const double sign = ray.has_dielectric_tm && !ray.has_odd_conductors ? -1.0 : 1.0;
  // Polarised, all coefficients are in the matrix.
  const std::complex<double> scalar =
      settings_.is_polarized ? 1.0 : ray.coefficient * surface.response.gamma * surface.response.coherent * sign;
  const std::complex<double> weight = std::complex<double>(0.0, 1.0) * ray.field_factor * scalar * launch_area;
  for (const Leg& leg : scratch.receive) {
    const OrderShares shares = ray.num_mirrors > 0 ? shares_of_orders(ray, surface, leg, block) : OrderShares{};
    record(ray, surface, leg, 0, settings_.is_polarized ? weight : weight * leg.gain, shares, scratch, block);
  }
}

// One path over the ray's own hits and a receive leg, and its reversal, as far as each has a share.
void RayShooter::record(const Ray& ray, const Surface& surface, const Leg& leg, uint64_t bits, std::complex<double> weight,
                        const OrderShares& shares, const Scratch& scratch, PathBlock& block) const {
  const int count = ray.depth + leg.num_bounces;
  if (count > settings_.max_bounces) return;
  if (shares.own > 0) {
    const std::complex<float> rounded(shares.own * weight);
    if (leg.num_bounces == 0) block.add_prefix(ray.depth, bits, rounded, ray.stratum);
    else block.add(way_back_over(ray, leg).data(), count, bits, rounded, ray.stratum);
    set_columns(ray, surface, leg, bits, scratch, block);
  }
  if (shares.opposite == 0) return;
  const std::complex<float> rounded(shares.opposite * weight);
  block.add_reversal(way_back_over(ray, leg).data(), count, bits, rounded, ray.stratum);
  set_columns(ray, surface, leg, bits, scratch, block);
}

// What the last path needs beside its weight, if the scene asks for it. `leg`: one of scratch.receive.
void RayShooter::set_columns(const Ray& ray, const Surface& surface, const Leg& leg, uint64_t bits, const Scratch& scratch,
                             PathBlock& block) const {
  if (bits == 0 && ray.is_curved) block.set_curved_cell(cell_behind_curves(ray, surface));
  if (!settings_.is_polarized) return;
  const FieldPair& axes = scratch.axes[static_cast<size_t>(&leg - scratch.receive.data())];
  block.set_jones(bits == 0 ? coherent_matrix(ray, surface, leg, axes) : diffuse_matrix(ray, surface, leg, axes));
}

// The launch cell of the ray's own stratum on the triangle that was hit (Paths::curved_cell).
std::array<float, 7> RayShooter::cell_behind_curves(const Ray& ray, const Surface& surface) const {
  const Hit& hit = surface.point.hit;
  const auto [a, b, c] = geometry_.corners(hit.mesh_id, hit.triangle_id);
  const double side = 1.0 / std::sqrt(plan_.lattice_density(ray.stratum));
  // A tube that the caustic limit widened keeps its proportions.
  const double widened = std::sqrt(surface.tube_area / std::max(std::abs(ray.rays.area(ray.direction, 0.0)), 1e-30));
  const double scale = side * std::min(widened, 1e6);
  std::array<float, 7> cell{};
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector2d at = edge_coordinates(b - a, c - a, surface.point.normal, ray.rays.point[axis] * scale);
    cell[2 * axis] = static_cast<float>(at[0]);
    cell[2 * axis + 1] = static_cast<float>(at[1]);
  }
  const auto turn = [&](int i, int j) { return side * scale * ray.rays.point[i].dot(ray.rays.turn[j]); };
  cell[4] = static_cast<float>(turn(0, 0));
  cell[5] = static_cast<float>(0.5 * (turn(0, 1) + turn(1, 0)));
  cell[6] = static_cast<float>(turn(1, 1));
  return cell;
}

void RayShooter::connect_diffuse(const Ray& ray, const Surface& surface, const Scratch& scratch, PathBlock& block) const {
  const std::complex<double> scalar =
      settings_.is_polarized ? 1.0 : ray.coefficient * diffuse_coefficient(surface.response);
  const std::complex<double> weight = scalar * std::sqrt(surface.area) * surface.chance.phase;
  const uint64_t bits = uint64_t{1} << (ray.depth - 1);
  const OrderShares shares{1.0, ray.num_mirrors > 0 ? 1.0 : 0.0};
  for (const Leg& leg : scratch.receive) {
    record(ray, surface, leg, bits, settings_.is_polarized ? weight : weight * leg.gain, shares, scratch, block);
  }
}

// Rays per sr at the antenna's end of a transmit leg that come over it to a first hit on a mesh, and go on at all its mirrors:
// those that aim there do.
double RayShooter::density_over(uint32_t mesh_id, const Leg& leg) const {
  const int stratum = plan_.owners.owner(mesh_id, leg.sequence);
  return plan_.density(stratum) * (plan_.is_field_of_view(stratum) ? leg.specular_share : 1.0);
}

// The balance weight: one over the number of hits per m^2 that all visible transmit legs together make here, the ray's own
// way and the `others`, times what the ray stands for.
double RayShooter::material_area(const Ray& ray, const Surface& surface, const std::vector<Leg>& others) const {
  double hits_per_area = ray.launch_density * ray.chain_share * surface.cos_incidence / (ray.leg_length * ray.leg_length);
  for (const Leg& leg : others) {
    hits_per_area += density_over(surface.point.hit.mesh_id, leg) * surface.point.normal.dot(leg.to_antenna) / (leg.length * leg.length);
  }
  return ray.stands_for / hits_per_area;
}

void RayShooter::connect_all_pairs(const Ray& ray, const Surface& surface, Scratch& scratch, PathBlock& block) const {
  find_transmit_legs(surface, settings_.max_bounces - 1, ray.sequence, scratch);
  const std::complex<double> weight = std::sqrt(material_area(ray, surface, scratch.transmit)) * surface.chance.phase;
  if (!scratch.transmit.empty() || scratch.receive.size() > 1 || scratch.receive[0].num_bounces > 0) {
    return record_fan(ray, surface, weight, scratch, block);
  }
  const std::complex<double> own =
      settings_.is_polarized ? weight : weight * diffuse_coefficient(surface.response) * ray.coefficient;
  const uint64_t bits = uint64_t{1} << (ray.depth - 1);
  block.add_prefix(ray.depth, bits, std::complex<float>(own), ray.stratum);
  set_columns(ray, surface, scratch.receive[0], bits, scratch, block);
}

// Polarised, all coefficients are in the matrices of the pairs.
void RayShooter::record_fan(const Ray& ray, const Surface& surface, std::complex<double> weight, Scratch& scratch,
                            PathBlock& block) const {
  block.begin_fan(surface.point.hit, ray.stratum, settings_.max_bounces);
  for (const Leg& in : scratch.transmit) {
    block.add_leg_in(settings_.is_polarized ? weight : weight * diffuse_coefficient(response_toward(surface, in.to_antenna)) * in.gain);
    for (int k = in.num_bounces; k-- > 0;) block.add_leg_hit(in.bounces[static_cast<size_t>(k)].hit);
  }
  block.add_leg_in(settings_.is_polarized ? weight : weight * diffuse_coefficient(surface.response) * ray.coefficient);
  for (int k = 0; k < ray.depth - 1; ++k) block.add_leg_hit(ray.hits[static_cast<size_t>(k)]);
  for (const Leg& out : scratch.receive) {
    block.add_leg_out(settings_.is_polarized ? 1.0 : out.gain);
    for (int k = 0; k < out.num_bounces; ++k) block.add_leg_hit(out.bounces[static_cast<size_t>(k)].hit);
  }
  if (settings_.is_polarized) add_pair_matrices(ray, surface, scratch, block);
  block.end_fan();
}

}  // namespace echopath
