// Neighbouring rays up to their first hits, and from there as far as it can be told lane by lane.
//
// Where a hit has no other legs than straight ones and fields need not be followed, what it sends to the receiver comes from
// its lane, and a ray is made only of what meets something behind it.
#include <memory>

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
  run_simd<&weigh_lanes<Packet>>(&packet);
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
    for (int lane = lanes.begin; lane < lanes.end; ++lane) packet.densities[lane] = plan_.density(stratum);
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
    packet.arrives[k] = packet.is_owned[k] || passes_on;
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
  const Odds odds = !packet.is_owned[k] ? kPassingOn : is_constant ? constant_odds_[mesh] : odds_of(model, response);
  packet.set_response(lane, response, odds);
  packet.goes_on[k] = settings_.max_bounces > 1 && response.gamma != 0.0;
  packet.is_plain[k] = has_only_direct_legs_ && !model.material().mirror && !is_near;
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
    packet.receiver[k] = !asked[k] ? Sight::kUnknown : blocked[k] ? Sight::kBlocked : Sight::kOpen;
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
  if (goes_on && travel(ray, departure_of(packet, lane), met, surface, scratch, block)) follow(ray, surface, scratch, block);
  block.end_ray(ray.hits.data());
}

// What a plain hit sends to the receiver, over the first hit of the current ray.
void RayShooter::add_echoes(const Packet& packet, int lane, PathBlock& block) {
  const auto k = static_cast<size_t>(lane);
  if (packet.receiver[k] != Sight::kOpen) return;
  const int stratum = packet.places.strata[k];
  if (packet.coherent[lane] > 0) block.add_prefix(1, 0, {packet.field_re[lane], packet.field_im[lane]}, stratum);
  if (packet.diffuse[lane] > 0) block.add_prefix(1, 1, {packet.power_re[lane], packet.power_im[lane]}, stratum);
}

RayShooter::Departure RayShooter::departure_of(const Packet& packet, int lane) {
  static_assert(kRouletteBounce > 1, "first hits know of no roulette");
  Departure way;
  way.from = packet.lifted[lane];
  way.direction = packet.out[lane];
  way.is_specular = packet.chance.lobe_coin[lane] < packet.specular_odds[lane];
  way.odds = way.is_specular ? packet.specular_odds[lane] : packet.diffuse_odds[lane];
  return way;
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
  ray.leg_density = ray.launch_density = packet.densities[lane];
  if (settings_.is_polarized) ray.polarized = launched_fields(ray.direction);
  if (has_smooth_) ray.rays = RayDifferential::from_point(ray.direction);
  surface.point = packet.hits[lane];
  surface.receiver = packet.receiver[k];
  surface.chance = packet.chance.hit(lane);
  surface.cos_incidence = packet.cos_incidence[lane];
  surface.model = packet.models[k];
  surface.mode = packet.modes[k];
  surface.response = packet.response(lane);
  settle(ray, surface);
  return scratch.first;
}

}  // namespace echopath
