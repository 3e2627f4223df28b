#include "echopath/trace/edges/edge_power.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/scene/scene_edges.h"
#include "echopath/trace/edges/posed_edge.h"
#include "echopath/trace/near_antenna.h"

namespace echopath {
namespace {

// Holds a straight way between an antenna and a point.
struct WayTo {
  Vec3 toward;  // unit, from the antenna
  double length, gain;
  Vec3 field;  // unit, or zero
};

WayTo way_to(const PosedAntenna& antenna, const Vec3& point) {
  const Vec3 line = point - antenna.position;
  WayTo way{line.normalized(), line.norm(), 0.0, Vec3::Zero()};
  way.gain = antenna.toward(way.toward).power;
  const Vec3 across = antenna.polarization - way.toward.dot(antenna.polarization) * way.toward;
  if (across.norm() > 1e-9) way.field = across.normalized();
  return way;
}

class EdgeEstimate {
 public:
  EdgeEstimate(const Radar& radar, const Transform& world_from_radar)
      : frequency_(radar.waveform.start_frequency), wavenumber_(kTwoPi * frequency_ / kSpeedOfLight),
        transmit_power_(radar.transmit_power),
        transmitter_(posed_antennas(radar.transmitters, world_from_radar, Vec3::Zero()).front()),
        receiver_(posed_antennas(radar.receivers, world_from_radar, Vec3::Zero()).front()) {}

  double power(const PosedEdge& edge, const Material& material) const {
    const Vec3 line = edge.to - edge.from, middle = 0.5 * (transmitter_.position + receiver_.position);
    const double length = line.norm(), at = std::clamp(line.dot(middle - edge.from) / line.squaredNorm(), 0.0, 1.0);
    const Vec3 point = edge.from + at * line;
    const WayTo in = way_to(transmitter_, point), out = way_to(receiver_, point);
    if (in.length < kNearAntenna || out.length < kNearAntenna) return 0.0;
    const Vec3 departure = -out.toward;
    const double coupled = std::abs(out.field.dot(fringe_matrix(edge.wedge, in.toward, departure) * in.field));
    const double slope = wavenumber_ * std::abs((in.toward - departure).dot(line)) / length;
    const double zone = 2.0 * std::sqrt(kPi / (wavenumber_ * (1.0 / in.length + 1.0 / out.length)));
    const double effective = std::min({length, zone, 2.0 / std::max(slope, 1e-9)});
    const double field = coupled * effective * kept_share(material, frequency_, edge.wedge, -in.toward) /
                         (4.0 * kPi * 2.0 * wavenumber_ * in.length * out.length);
    return transmit_power_ * in.gain * out.gain * field * field;
  }

 private:
  double frequency_, wavenumber_, transmit_power_;  // Hz, rad/m, W
  PosedAntenna transmitter_, receiver_;
};

}  // namespace

double strongest_edge(const Scene& scene, const Radar& radar, double time) {
  const SceneEdges edges(scene);
  const PosedScene pose(scene, time);
  const EdgeEstimate estimate(radar, radar.world_from_radar(time));
  double strongest = 0.0;
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) {
    const Mesh& mesh = *scene.node_of(id).mesh;
    const auto corner = [&](uint32_t triangle, uint32_t index) -> Vec3 {
      return pose.linear(id) * mesh.vertices()[mesh.triangles()[triangle][index]] + pose.world_translation(id);
    };
    for (const SharpEdge& edge : edges.of(id)) {
      const Vec3 from = corner(edge.triangle, edge.side), line = corner(edge.triangle, (edge.side + 1) % 3) - from;
      const PosedEdge posed{id, edge, posed_wedge(edge, pose, id), from + edge.begin * line, from + edge.end * line};
      strongest = std::max(strongest, estimate.power(posed, *scene.node_of(id).material));
    }
  }
  return strongest;
}

}  // namespace echopath
