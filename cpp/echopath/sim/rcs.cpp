#include "echopath/sim/rcs.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/base/range_of_coordinates.h"
#include "echopath/base/text/streamed.h"
#include "echopath/posed/posed_scene.h"
#include "echopath/power/received_power.h"
#include "echopath/record/hit_points.h"

namespace echopath {
namespace {

constexpr double kPhaseError = 1e-3;      // rad, of the spherical wave fronts of both antennas together
constexpr double kAmplitudeError = 1e-4;  // relative, of their spreading
constexpr double kReachOfBias = 1.96;     // the bias reaches to the end of a 95 % interval
constexpr double kSmallestSine = 1e-3;    // of the angle between line of sight and polarization
constexpr double kNull = 1e-2;            // of the square of the wavelength
constexpr double kInPlane = 1e-6;         // of the target's radius, how far from a plane points of it may lie

struct Target {
  Vec3 centre = Vec3::Zero();
  double radius = 0.0;
};

// Returns the bounding sphere about the middle of the bounding box, in world coordinates.
Target target_of(const Scene& scene) {
  require(!scene.meshes().empty(), "scene", "must have a mesh, meshes", scene.meshes().size());
  const PosedScene pose(scene, 0.0);
  std::vector<Vec3> points;
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) {
    const Node& node = scene.node_of(id);
    require(!node.material->mirror, "scene", "must have no mesh marked mirror, which has no cross section", node.name);
    for (const Vec3& vertex : pose.world_vertices(id)) points.push_back(vertex);
  }
  Target target{box_about(points).center(), 0.0};
  for (const Vec3& point : points) target.radius = std::max(target.radius, (point - target.centre).norm());
  return target;
}

// A wave front of radius R lags by k r^2 / 2R at the rim of the target, once on the way out and once on the way back.
// Larger targets need a far field in which double precision does not resolve the phase.
double far_distance(const Target& target, double wavenumber) {
  const double flat = wavenumber * target.radius * target.radius / kPhaseError;
  const double distance = std::max({flat, target.radius / kAmplitudeError, kTwoPi / wavenumber});
  if (distance <= kFarthest) return distance;
  const double largest = std::min(std::sqrt(kFarthest * kPhaseError / wavenumber), kFarthest * kAmplitudeError);
  require(false, "scene",
          streamed("must fit into a sphere of radius ", largest,
                   " m at this frequency (are its vertices in metres?), radius in m"),
          target.radius);
  return distance;
}

Antenna far_antenna(const Target& target, const Vec3& direction, double distance, const RcsPolarization& polarization,
                    const char* name) {
  const double length = direction.norm();
  require(std::isfinite(length) && length > 0, name, "must be finite and not zero, length", length);
  const Vec3 toward = direction / length;
  Antenna antenna;
  antenna.position = target.centre + distance * toward;
  antenna.polarization = polarization.across(toward);
  return antenna;
}

// Holds the channels of one pair of directions that share a transmit polarisation, and so a trace.
struct Shot {
  Radar radar;                   // a receiver for each channel
  std::vector<size_t> channels;  // indices into the results
};

// Returns a radar for time 0 and one frequency, whose frame is too short for anything to move.
Radar far_radar(double frequency, const Antenna& transmitter) {
  Radar radar;
  radar.waveform.start_frequency = frequency;
  radar.waveform.bandwidth = 1.0;
  radar.waveform.num_samples = 1;
  radar.waveform.sampling_rate = 1e15;
  radar.waveform.num_chirps = 1;
  radar.transmit_power = 1.0;
  radar.transmitters = {transmitter};
  return radar;
}

// Appends the shots of one pair, whose results begin at `first`.
void add_shots(const Target& target, const RcsDirections& pair, double distance, const RcsSettings& settings, size_t first,
               std::vector<Shot>& shots) {
  const size_t own = shots.size();
  std::vector<RcsPolarization> transmitted;
  for (size_t i = 0; i < settings.channels.size(); ++i) {
    const auto& [transmit, receive] = settings.channels[i];
    const auto found = std::ranges::find(transmitted, transmit);
    const size_t index = own + static_cast<size_t>(found - transmitted.begin());
    if (found == transmitted.end()) {
      transmitted.push_back(transmit);
      const Antenna transmitter = far_antenna(target, pair.incidence, distance, transmit, "incidence");
      shots.push_back({far_radar(settings.frequency, transmitter), {}});
    }
    shots[index].radar.receivers.push_back(far_antenna(target, pair.observation, distance, receive, "observation"));
    shots[index].channels.push_back(first + i);
  }
}

// `scale` is as in `cross_section`.
Paths shoot(const SceneSnapshot& scene, const Radar& radar, const RcsSettings& settings, double scale, Job* job,
            KeptGeometry* kept) {
  if (!settings.target) return trace(scene, radar, settings.tracing, job, kept);
  ErrorTarget wanted = *settings.target;
  wanted.least_power = largest_null(settings.frequency) / scale;
  return trace_to_error(scene, radar, settings.tracing, wanted, job, kept);
}

// Returns how far a wave that would touch the world's origin on its way would go, m.
double length_over_origin(const Paths& paths, int receiver, const Vec3& centre) {
  const auto leg = [&](const Antenna& antenna) {
    const Vec3 sight = antenna.position - centre;
    return sight.norm() + sight.normalized().dot(centre);
  };
  return leg(paths.radar.transmitters.front()) + leg(paths.radar.receivers[receiver]);
}

// Tells which paths stay outside of the cavities.
class OutsideOfCavities {
 public:
  // The scene must outlive it.
  OutsideOfCavities(const Scene& scene, const std::vector<RcsCavity>& cavities, double tolerance)
      : pose_(scene, 0.0), cavities_(cavities), tolerance_(tolerance), cavity_of_(scene.meshes().size(), -1) {
    for (size_t i = 0; i < cavities.size(); ++i) {
      for (const uint32_t wall : cavities[i].walls) cavity_of_.at(wall) = static_cast<int>(i);
    }
  }

  Paths select(const Paths& paths, Job* job) const {
    std::vector<uint8_t> keep(paths.num_paths());
    for (int64_t path = 0; path < paths.num_paths(); ++path) {
      const Hit* hits = paths.hits_of(path);
      const int count = paths.num_bounces[path];
      keep[path] = std::none_of(hits, hits + count, [&](const Hit& hit) { return is_inside(hit); });
    }
    return paths.select(keep, job);
  }

 private:
  bool is_inside(const Hit& hit) const {
    const int cavity = cavity_of_[hit.mesh_id];
    if (cavity < 0) return false;
    return std::abs(cavities_[cavity].mouth.height(hit_point(pose_, hit))) > tolerance_;
  }

  PosedScene pose_;
  const std::vector<RcsCavity>& cavities_;
  double tolerance_;            // m
  std::vector<int> cavity_of_;  // [mesh_id], -1: none
};

// `scale` is in m^2 per W at the antenna port for 1 W transmitted.
RadarCrossSection cross_section(const Paths& paths, int receiver, const Vec3& centre, double scale, Job* job) {
  const ReceivedPower power = received_power(paths, job, {0, receiver});
  const double bias = power.bias / kReachOfBias;
  RadarCrossSection out;
  out.total = scale * power.power;
  out.standard_error = scale * std::hypot(power.standard_error, bias);
  out.coherent = scale * power.coherent;
  out.coherent_error = scale * std::hypot(power.coherent_error, bias);
  out.diffuse = scale * power.diffuse;
  out.diffuse_error = scale * power.diffuse_error;
  out.error_db = paths.frame.error_db;
  out.high = scale * power.high;
  const double wavenumber = kTwoPi * paths.radar.waveform.start_frequency / kSpeedOfLight;
  out.field = power.field * std::sqrt(scale / (4.0 * kPi)) *
              std::polar(1.0, wavenumber * length_over_origin(paths, receiver, centre));
  return out;
}

}  // namespace

Vec3 RcsPolarization::across(const Vec3& toward) const {
  const TransverseBasis basis = transverse_basis(toward);
  if (kind == Kind::kHorizontal) return basis.horizontal;
  if (kind == Kind::kVertical) return basis.vertical;
  const Vec3 unit = vector.normalized();
  const Vec3 rest = unit - toward.dot(unit) * toward;
  require(rest.norm() > kSmallestSine, "polarization", "must not lie along a direction, sine of the angle", rest.norm());
  return rest.normalized();
}

double largest_null(double frequency) {
  const double wavelength = kSpeedOfLight / frequency;
  return kNull * wavelength * wavelength;
}

void RcsSettings::validate() const {
  require(std::isfinite(frequency) && frequency > 0, "frequency", "must be finite and > 0 Hz", frequency);
  require(!channels.empty(), "polarization", "must name at least one channel, channels", channels.size());
  for (const RcsChannel& channel : channels) {
    for (const RcsPolarization* polarization : {&channel.transmit, &channel.receive}) {
      const double length = polarization->vector.norm();
      require(std::isfinite(length) && length > 0, "polarization", "must be finite and not zero, length", length);
    }
    require(tracing.polarization == PolarizationModel::kJones || channel.transmit == channel.receive, "polarization",
            "must be the same for both antennas in the scalar model, receive", channel.receive.vector.transpose());
  }
  tracing.validate();
  if (target) target->validate();
}

std::vector<RadarCrossSection> rcs(const Scene& scene, std::span<const RcsDirections> directions,
                                   const RcsSettings& settings, Job* job) {
  settings.validate();
  const Target target = target_of(scene);
  const SceneSnapshot snapshot(scene);
  const double wavenumber = kTwoPi * settings.frequency / kSpeedOfLight;
  const double distance = far_distance(target, wavenumber);
  // The scale is (4 pi)^3 R^4 / lambda^2 for Q^2 = 1 W.
  const double scale = std::pow(4.0 * kPi, 3) * std::pow(distance, 4) * std::pow(wavenumber / kTwoPi, 2);
  std::vector<Shot> shots;
  for (size_t i = 0; i < directions.size(); ++i) {
    add_shots(target, directions[i], distance, settings, i * settings.channels.size(), shots);
  }

  std::optional<OutsideOfCavities> outside;
  if (!settings.cavities.empty()) outside.emplace(scene, settings.cavities, kInPlane * target.radius);
  std::vector<RadarCrossSection> out(directions.size() * settings.channels.size());
  const bool is_one = shots.size() == 1;  // its progress is that of its trace, else by shots
  if (job) job->start(std::ssize(shots));
  KeptGeometry kept;
  for (const Shot& shot : shots) {
    Job part(job);
    Paths paths = shoot(snapshot, shot.radar, settings, scale, is_one && job ? job : &part, &kept);
    if (outside) paths = outside->select(paths, &part);
    for (size_t i = 0; i < shot.channels.size(); ++i) {
      out[shot.channels[i]] = cross_section(paths, static_cast<int>(i), target.centre, scale, &part);
    }
    if (job && !is_one) job->advance(1);
  }
  return out;
}

}  // namespace echopath
