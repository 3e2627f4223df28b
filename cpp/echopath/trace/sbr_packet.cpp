// Neighbouring rays up to their first hits, and from there as far as it can be told lane by lane.
//
// Where a hit has no other legs than straight ones, what it sends to the receiver comes from
// its lane, and a ray is made only of what meets something behind it.
#include <cmath>
#include <memory>

#include "echopath/base/constants.h"
#include "echopath/base/simd.h"
#include "echopath/trace/sbr_state.h"

namespace echopath {
namespace {

struct Antennas {
  VectorOf<double> transmitter, receiver;
};

// What a packet's hits look like from its antennas.
template <class Packet>
ECHOPATH_INLINE void see_lanes(Packet* packet, Antennas at, double lift) {
  ECHOPATH_SIDE_BY_SIDE
  for (int lane = 0; lane < kPacketSize; ++lane) {
    const VectorOf<double> position = packet->hits.position.at(lane), normal = packet->hits.normal.at(lane);
    const VectorOf<double> to_receiver = at.receiver - position, to_transmitter = at.transmitter - position;
    packet->cos_incidence[lane] = -dot(normal, packet->directions.at(lane));
    packet->cos_receiver[lane] = dot(normal, to_receiver);
    packet->near_squared[lane] = ScalarMath::smaller(dot(to_receiver, to_receiver), dot(to_transmitter, to_transmitter));
    packet->lifted.set(lane, position + lift * normal);
  }
}

// Echoes of plain hits: of one ray's cell by physical optics and of its patch with a random phase (connect_coherent and
// connect_diffuse tell why).
template <class Packet>
ECHOPATH_INLINE void weigh_lanes(Packet* packet) {
  ECHOPATH_SIDE_BY_SIDE
  for (int lane = 0; lane < kPacketSize; ++lane) {
    const double distance = packet->hits.distance[lane], re = packet->gamma_re[lane], im = packet->gamma_im[lane];
    const double area = distance * distance / (packet->densities[lane] * packet->cos_incidence[lane]);
    const double field = area * packet->hits.stretch[lane] * packet->coherent[lane] * packet->sign[lane];
    packet->field_re[lane] = static_cast<float>(-im * field);
    packet->field_im[lane] = static_cast<float>(re * field);
    const double power = ScalarMath::root(area) * packet->facet[lane] * packet->diffuse[lane];
    packet->power_re[lane] = static_cast<float>(power * packet->chance.phase_re[lane]);
    packet->power_im[lane] = static_cast<float>(power * packet->chance.phase_im[lane]);
  }
}

// The matrix of a hit between a launch, whose horizontal field is (x, y) of TE and TM and whose vertical one is (y, -x), and
// straight ways on: re and im of each entry of a JonesMatrix.
ECHOPATH_INLINE void set_entries(const BasisAcross& launched, const ModeAxes& modes, const HitMatrix& hit, double scale,
                                 LanesOf<float> (*to)[2], int lane) {
  const double x = scale * dot(launched.horizontal, modes.te), y = scale * dot(launched.vertical, modes.te);
  const auto set = [&](int entry, const ComplexOf<double>& te, const ComplexOf<double>& tm) {
    to[entry][0][lane] = static_cast<float>(x * te.re + y * tm.re);
    to[entry][1][lane] = static_cast<float>(x * te.im + y * tm.im);
    to[entry + 1][0][lane] = static_cast<float>(y * te.re - x * tm.re);
    to[entry + 1][1][lane] = static_cast<float>(y * te.im - x * tm.im);
  };
  set(0, hit.h_te, hit.h_tm);
  set(2, hit.v_te, hit.v_tm);
}

// Likewise of field vectors (coherent_matrix and diffuse_matrix).
template <class Packet>
ECHOPATH_INLINE void polarize_lanes(Packet* packet, VectorOf<double> receiver) {
  ECHOPATH_SIDE_BY_SIDE
  for (int lane = 0; lane < kPacketSize; ++lane) {
    const double distance = packet->hits.distance[lane], cos_incidence = packet->cos_incidence[lane];
    const double area = distance * distance / (packet->densities[lane] * cos_incidence), root_area = ScalarMath::root(area);
    packet->field_re[lane] = 0.0f;
    packet->field_im[lane] = static_cast<float>(area * packet->hits.stretch[lane]);
    packet->power_re[lane] = static_cast<float>(root_area * packet->chance.phase_re[lane]);
    packet->power_im[lane] = static_cast<float>(root_area * packet->chance.phase_im[lane]);
    const VectorOf<double> line = receiver - packet->hits.position.at(lane), direction = packet->directions.at(lane);
    const double inverse = 1.0 / ScalarMath::root(dot(line, line));
    const HitGeometryOfModes hit = hit_geometry(direction, packet->hits.normal.at(lane), inverse * line);
    const ComplexOf<double> te{packet->te_re[lane], packet->te_im[lane]}, tm{packet->tm_re[lane], packet->tm_im[lane]};
    const double scale = packet->coherent[lane] * polarized_scale(cos_incidence, inverse * packet->cos_receiver[lane]);
    const BasisAcross launched = basis_across(direction);
    set_entries(launched, hit.modes, radiated_modes(hit, te, tm), scale, packet->field_jones, lane);
    const AxisInModes axis = scattering_axis(hit, packet->axis_cosine[lane], packet->axis_sine[lane]);
    set_entries(launched, hit.modes, scattered_modes(hit, packet->facet[lane], mixing_of(packet->cross_share[lane]), axis),
                packet->diffuse[lane], packet->power_jones, lane);
  }
}

template <class Packet>
ECHOPATH_INLINE void leave_lanes(Packet* packet) {
  ECHOPATH_SIDE_BY_SIDE
  for (int lane = 0; lane < kPacketSize; ++lane) {
    const VectorOf<double> normal = packet->hits.normal.at(lane);
    const VectorOf<double> specular = mirrored(normal, packet->directions.at(lane), packet->cos_incidence[lane]);
    const VectorOf<double> diffuse = over_surface(normal, packet->chance.lobe.at(lane));
    const double coin = packet->chance.lobe_coin[lane], odds = packet->specular_odds[lane];
    packet->out.x[lane] = coin < odds ? specular.x : diffuse.x;
    packet->out.y[lane] = coin < odds ? specular.y : diffuse.y;
    packet->out.z[lane] = coin < odds ? specular.z : diffuse.z;
  }
}

}  // namespace

void RayShooter::shoot_packet(Packet& packet, Scratch& scratch, PathBlock& block) const {
  launch_packet(packet);
  geometry_.intersect(settings_.transmitter, packet.directions, packet.count, packet.hits);
  block.statistics.num_queries += packet.count;
  arrive_packet(packet, block);
  look_at_receiver(packet, block);
  if (settings_.is_polarized && has_only_direct_legs_) {
    run_simd<&polarize_lanes<Packet>>(&packet, unpacked(settings_.receiver));
  } else {
    run_simd<&weigh_lanes<Packet>>(&packet);
  }
  run_simd<&leave_lanes<Packet>>(&packet);
  for (int lane = 0; lane < packet.count; ++lane) {
    if (packet.arrives[static_cast<size_t>(lane)]) shoot_lane(packet, lane, scratch, block);
  }
}

void RayShooter::launch_packet(Packet& packet) const {
  LaunchPlan::Places& places = packet.places;
  plan_.place(packet.begin, packet.count, places);
  for (LaneRange lanes{0, 0}; lanes.begin < packet.count; lanes.begin = lanes.end) {
    const int stratum = places.strata[static_cast<size_t>(lanes.begin)];
    while (lanes.end < packet.count && places.strata[static_cast<size_t>(lanes.end)] == stratum) ++lanes.end;
    directions_.launch(stratum, places.x, places.y, lanes, packet.directions);
    const double density = plan_.density(plan_.foci.owner(stratum));
    const bool has_foci = plan_.foci.has_any(stratum);
    for (int lane = lanes.begin; lane < lanes.end; ++lane) {
      packet.densities[lane] = has_foci ? density / plan_.foci.rays_of_owner(stratum, packet.directions[lane]) : density;
    }
  }
  packet.chance.draw(settings_.seed, packet.begin, packet.count, places.batches.data());
}

void RayShooter::arrive_packet(Packet& packet, PathBlock& block) const {
  const Antennas antennas{unpacked(settings_.transmitter), unpacked(settings_.receiver)};
  run_simd<&see_lanes<Packet>>(&packet, antennas, geometry_.lift());
  for (int lane = 0; lane < kPacketSize; ++lane) {
    const auto k = static_cast<size_t>(lane);
    const EmbreeScene::Verdict verdict = packet.hits.verdicts[k];
    const bool is_hit = verdict == EmbreeScene::Verdict::kHit;
    packet.arrives[k] = is_hit && packet.cos_incidence[lane] >= kGrazing;
    if (verdict == EmbreeScene::Verdict::kFalseHit) ++block.statistics.num_false_hits;
    if (is_hit && !packet.arrives[k]) ++block.statistics.num_grazing;
    if (!packet.arrives[k]) continue;
    const uint32_t mesh = packet.hits.met[k].mesh_id;
    const bool passes_on = passes(packet.places.strata[k], mesh);
    packet.is_owned[k] = !passes_on && is_owner(packet.places.strata[k], mesh, kDirect);
    packet.arrives[k] = (packet.is_owned[k] || passes_on) && std::isfinite(packet.densities[lane]);  // else foci have it all
    if (!packet.arrives[k]) continue;
    ++block.statistics.num_hits;
    look_at_surface(packet, lane);
  }
}

void RayShooter::look_at_surface(Packet& packet, int lane) const {
  const auto k = static_cast<size_t>(lane);
  const uint32_t mesh = packet.hits.met[k].mesh_id;
  const SurfaceModel& model = models_[mesh];
  packet.models[k] = &model;
  const bool is_constant = model.is_constant(), is_near = packet.near_squared[lane] < kNearAntenna * kNearAntenna;
  packet.modes[k] = is_constant ? PolarizationMode::kTe
                                : mode_along(model, settings_.polarization, packet.directions[lane], packet.hits.normal[lane]);
  const SurfaceResponse response = model.respond(packet.cos_incidence[lane], packet.modes[k]);
  const LobeProbabilities odds = !packet.is_owned[k] ? kPassingOn : is_constant ? constant_odds_[mesh] : odds_of(model, response);
  packet.set_response(lane, response, odds);
  if (settings_.is_polarized && has_only_direct_legs_) look_at_modes(packet, lane);
  packet.goes_on[k] = settings_.max_bounces > 1 && response.gamma != 0.0;
  packet.is_plain[k] = has_only_direct_legs_ && !model.material().mirror && !is_near;
}

// What a surface makes of field vectors.
void RayShooter::look_at_modes(Packet& packet, int lane) const {
  const SurfaceModel& model = *packet.models[static_cast<size_t>(lane)];
  const ModeCoefficients modes = model.modes(packet.cos_incidence[lane]);
  packet.te_re[lane] = modes.te.real();
  packet.te_im[lane] = modes.te.imag();
  packet.tm_re[lane] = modes.tm.real();
  packet.tm_im[lane] = modes.tm.imag();
  const double share = packet.cross_share[lane] = model.material().cross_polarization;
  const double axis = share > 0 ? kPi * packet.chance.axis_coin[lane] : 0.0;
  packet.axis_cosine[lane] = share > 0 ? std::cos(axis) : 1.0;
  packet.axis_sine[lane] = share > 0 ? std::sin(axis) : 0.0;
}

// From all first hits together: they lie beside each other. What a mirror needs depends on more.
void RayShooter::look_at_receiver(Packet& packet, PathBlock& block) const {
  EmbreeScene::Lanes asked, blocked;
  for (size_t k = 0; k < kPacketSize; ++k) {
    asked[k] = packet.arrives[k] && !packet.models[k]->material().mirror && packet.cos_receiver.lanes[k] > 0;
    block.statistics.num_queries += asked[k];
  }
  geometry_.occluded(packet.lifted, settings_.receiver, asked, blocked);
  for (size_t k = 0; k < kPacketSize; ++k) {
    packet.receiver[k] = !asked[k] ? ShadowState::kUnknown : blocked[k] ? ShadowState::kBlocked : ShadowState::kOpen;
  }
}

void RayShooter::shoot_lane(const Packet& packet, int lane, Scratch& scratch, PathBlock& block) const {
  const auto k = static_cast<size_t>(lane);
  block.current_batch = static_cast<uint8_t>(packet.places.batches[k]);
  block.current_half = half_of_ray(packet.begin + lane);
  RayHit met;
  const bool goes_on =
      packet.goes_on[k] && ask(packet.lifted[lane], packet.out[lane], met, block) == EmbreeScene::Verdict::kHit;
  if (packet.is_plain[k]) add_echoes(packet, lane, block);
  if (packet.is_plain[k] && !goes_on) return block.end_ray(&packet.hits.met[k]);
  auto& [ray, surface] = start(packet, lane, scratch);
  if (!packet.is_plain[k]) connect(ray, surface, scratch, block);
  if (goes_on && travel(ray, sample_of(packet, lane), met, surface, scratch, block)) follow(ray, surface, scratch, block);
  block.end_ray(ray.hits.data());
}

namespace {

JonesMatrix entries_of(const LanesOf<float> (*from)[2], int lane) {
  const auto entry = [&](size_t i) { return std::complex<float>(from[i][0][lane], from[i][1][lane]); };
  return {entry(0), entry(1), entry(2), entry(3)};
}

}  // namespace

// What a plain hit sends to the receiver, over the first hit of the current ray.
void RayShooter::add_echoes(const Packet& packet, int lane, PathBlock& block) const {
  const auto k = static_cast<size_t>(lane);
  if (packet.receiver[k] != ShadowState::kOpen) return;
  const int stratum = packet.places.strata[k];
  if (packet.coherent[lane] > 0) {
    block.add_prefix(1, 0, {packet.field_re[lane], packet.field_im[lane]}, stratum);
    if (settings_.is_polarized) block.set_jones(entries_of(packet.field_jones, lane));
  }
  if (packet.diffuse[lane] > 0) {
    block.add_prefix(1, 1, {packet.power_re[lane], packet.power_im[lane]}, stratum);
    if (settings_.is_polarized) block.set_jones(entries_of(packet.power_jones, lane));
  }
}

RayShooter::ScatterSample RayShooter::sample_of(const Packet& packet, int lane) {
  static_assert(kRouletteBounce > 1, "first hits know of no roulette");
  ScatterSample sample;
  sample.from = packet.lifted[lane];
  sample.direction = packet.out[lane];
  sample.is_specular = packet.chance.lobe_coin[lane] < packet.specular_odds[lane];
  sample.odds = sample.is_specular ? packet.specular_odds[lane] : packet.diffuse_odds[lane];
  return sample;
}

// The ray of a lane at its first hit.
RayShooter::RayAtHit& RayShooter::start(const Packet& packet, int lane, Scratch& scratch) const {
  const auto k = static_cast<size_t>(lane);
  auto& [ray, surface] = *std::construct_at(&scratch.first);
  scratch.has_receive = false;
  ray.index = packet.begin + lane;
  ray.stratum = packet.places.strata[k];
  ray.direction = ray.launch_direction = packet.directions[lane];
  ray.is_owned = packet.is_owned[k];
  ray.launch_density = plan_.density(plan_.foci.owner(ray.stratum));
  ray.leg_density = packet.densities[lane];
  ray.stands_for = ray.launch_density / ray.leg_density;
  if (settings_.is_polarized) ray.polarized = launched_fields(ray.direction);
  if (has_smooth_) ray.rays = RayDifferential::from_point(ray.direction);
  surface.point = packet.hits[lane];
  surface.receiver = packet.receiver[k];
  surface.chance = packet.chance.hit(lane);
  surface.cos_incidence = packet.cos_incidence[lane];
  surface.model = packet.models[k];
  surface.mode = packet.modes[k];
  surface.response = packet.response(lane);
  record_hit(ray, surface);
  return scratch.first;
}

}  // namespace echopath
