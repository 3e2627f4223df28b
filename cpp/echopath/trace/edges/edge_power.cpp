#include "echopath/trace/edges/edge_power.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/radar/noise_power.h"
#include "echopath/record/near_antenna.h"

namespace echopath {
namespace {

constexpr double kOfNoise = 1e-4;  // of the noise in a cell: that of the weakest echoes of edges which are kept

EdgeLeg edge_leg_to(const Vec3& antenna, const Vec3& point) {
  const Vec3 line = point - antenna, direction = line.normalized();
  return {-direction, direction, line.norm()};
}

Vec3 centre_of_antennas(const std::vector<PosedAntenna>& antennas) {
  Vec3 sum = Vec3::Zero();
  for (const PosedAntenna& antenna : antennas) sum += antenna.position;
  return sum / static_cast<double>(antennas.size());
}

double best_gain(const std::vector<PosedAntenna>& antennas, const Vec3& direction) {
  double best = 0.0;
  for (const PosedAntenna& antenna : antennas) best = std::max(best, antenna.toward(direction).power);
  return best;
}

// Returns the largest field that a matrix brings from one of the transmitters to one of the receivers, for all of which the
// ways are about the same.
double best_coupling(const Mat3& matrix, const std::vector<PosedAntenna>& transmitters, const EdgeLeg& in,
                     const std::vector<PosedAntenna>& receivers, const EdgeLeg& out) {
  double best = 0.0;
  for (const PosedAntenna& transmitter : transmitters) {
    const Vec3 sent = matrix * unit_part_across(transmitter.polarization, in.at_antenna);
    for (const PosedAntenna& receiver : receivers)
      best = std::max(best, std::abs(unit_part_across(receiver.polarization, out.at_antenna).dot(sent)));
  }
  return best;
}

}  // namespace

EdgeEstimate::EdgeEstimate(const Radar& radar, const Transform& world_from_radar, const Vec3& origin)
    : frequency_(radar.waveform.start_frequency), wavenumber_(kTwoPi * frequency_ / kSpeedOfLight),
      transmit_power_(radar.transmit_power), transmitters_(posed_antennas(radar.transmitters, world_from_radar, origin)),
      receivers_(posed_antennas(radar.receivers, world_from_radar, origin)) {}

double EdgeEstimate::power(const PosedEdge& edge, const Material& material) const {
  const Vec3 sender = centre_of_antennas(transmitters_), receiver = centre_of_antennas(receivers_);
  const Vec3 line = edge.line(), middle = 0.5 * (sender + receiver);
  const Vec3 point = nearest_of_segment(middle, edge.from, edge.to);
  const EdgeLeg in = edge_leg_to(sender, point), out = edge_leg_to(receiver, point);
  const Mat3 fringe = fringe_matrix(edge.wedge, in.at_antenna, out.to_antenna);
  const double coupled = best_coupling(fringe, transmitters_, in, receivers_, out);
  return power(edge.wedge, in, out, coupled * kept_share(material, frequency_, edge.wedge, in.to_antenna), line.norm());
}

double EdgeEstimate::power(const Wedge& wedge, const EdgeLeg& in, const EdgeLeg& out, double coupled, double longest) const {
  if (!reaches_antenna(in.length) || !reaches_antenna(out.length)) return 0.0;
  const double slope = wavenumber_ * std::abs((in.to_antenna + out.to_antenna).dot(axis_of(wedge)));
  const double zone = 2.0 * std::sqrt(kPi / (wavenumber_ * (1.0 / in.length + 1.0 / out.length)));
  const double effective = std::min({longest, zone, 2.0 / std::max(slope, 1e-9)});
  const double field = edge_amplitude(coupled / (4.0 * kPi), effective, wavenumber_, in.length, out.length);
  return transmit_power_ * best_gain(transmitters_, in.at_antenna) * best_gain(receivers_, out.at_antenna) * field * field;
}

double strongest_of(std::span<const PosedEdge> edges, const Scene& scene, const EdgeEstimate& estimate) {
  double strongest = 0.0;
  for (const PosedEdge& edge : edges)
    strongest = std::max(strongest, estimate.power(edge, *scene.node_of(edge.mesh_id).material));
  return strongest;
}

double strongest_edge(const Scene& scene, const Radar& radar, double time) {
  const EdgeEstimate estimate(radar, radar.world_from_radar(time), Vec3::Zero());
  return strongest_of(posed_edges(scene, PosedScene(scene, time), Vec3::Zero()), scene, estimate);
}

double least_edge_power(double strongest, const Radar& radar) {
  const double noise = noise_power_in_cell(radar);
  return strongest > noise ? kOfNoise * noise : 0.0;
}

}  // namespace echopath
