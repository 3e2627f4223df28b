#include "echopath/sim/rcs.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "echopath/base/constants.h"
#include "echopath/base/parallel.h"
#include "echopath/replay/replay.h"
#include "echopath/trace/trace.h"

namespace echopath {
namespace {

constexpr double kPhaseError = 1e-3;      // rad, of the spherical wave fronts of both antennas together
constexpr double kAmplitudeError = 1e-4;  // relative, of their spreading
constexpr double kSmallestSine = 1e-3;    // between line of sight and polarization
constexpr int64_t kPathsPerBlock = 4096;

struct Target {
  Vec3 centre = Vec3::Zero();
  double radius = 0.0;
};

// Bounding sphere about the middle of the bounding box, in world coordinates.
Target target_of(const Scene& scene) {
  require(!scene.meshes().empty(), "scene", "must have a mesh, meshes", scene.meshes().size());
  const Pose pose(scene, 0.0);
  Eigen::AlignedBox3d box;
  std::vector<Vec3> points;
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) {
    const Node& node = scene.node_of(id);
    require(!node.material->mirror, "scene", "must have no mirrors, which have no cross section, mesh", node.name);
    for (const Vec3& vertex : pose.world_vertices(id)) points.push_back(vertex);
  }
  for (const Vec3& point : points) box.extend(point);
  Target target{box.center(), 0.0};
  for (const Vec3& point : points) target.radius = std::max(target.radius, (point - target.centre).norm());
  return target;
}

// A wave front of radius R lags by k r^2 / 2R at the rim of the target, once on the way out and once on the way back.
double far_distance(const Target& target, double wavenumber) {
  const double flat = wavenumber * target.radius * target.radius / kPhaseError;
  return std::max({flat, target.radius / kAmplitudeError, kTwoPi / wavenumber});
}

Antenna far_antenna(const Target& target, const Vec3& direction, double distance, const Vec3& polarization,
                    const char* name) {
  const double length = direction.norm();
  require(std::isfinite(length) && length > 0, name, "must be finite and not zero, length", length);
  const Vec3 toward = direction / length;
  const Vec3 across = polarization.normalized() - toward.dot(polarization.normalized()) * toward;
  require(across.norm() > kSmallestSine, "polarization", "must not lie along a direction, sine of the angle",
          across.norm());
  Antenna antenna;
  antenna.position = target.centre + distance * toward;
  antenna.polarization = across.normalized();
  return antenna;
}

// At time 0 and one frequency: a frame too short for anything to move.
Radar far_radar(const Target& target, const RcsDirections& pair, double distance, const RcsSettings& settings) {
  Radar radar;
  radar.waveform.start_frequency = settings.frequency;
  radar.waveform.bandwidth = 1.0;
  radar.waveform.num_samples = 1;
  radar.waveform.sampling_rate = 1e15;
  radar.waveform.num_chirps = 1;
  radar.transmit_power = 1.0;
  radar.transmitters = {far_antenna(target, pair.incidence, distance, settings.polarization, "incidence")};
  radar.receivers = {far_antenna(target, pair.observation, distance, settings.polarization, "observation")};
  return radar;
}

TraceSettings tracing_of(const RcsSettings& settings) {
  TraceSettings tracing;
  tracing.num_rays = settings.num_rays;
  tracing.max_bounces = settings.max_bounces;
  tracing.seed = settings.seed;
  tracing.footprint = settings.footprint;
  return tracing;
}

struct Sums {
  std::complex<double> field = 0.0;
  double power = 0.0;
};

Sums sum_block(const Paths& paths, const Replayer& replayer, double wavenumber, double distance, int64_t begin,
               int64_t end) {
  std::vector<int64_t> indices(static_cast<size_t>(end - begin));
  std::iota(indices.begin(), indices.end(), begin);
  std::vector<double> lengths;
  std::vector<std::complex<double>> amplitudes;
  replayer.evaluate(indices, paths.frame.trace_time, lengths, amplitudes);
  Sums sums;
  for (size_t i = 0; i < indices.size(); ++i) {
    // Phase relative to the centre of the target: that of the whole length would lose digits.
    if (paths.diffuse[static_cast<size_t>(indices[i])] == 0) {
      sums.field += amplitudes[i] * std::polar(1.0, -wavenumber * (lengths[i] - 2.0 * distance));
    } else {
      sums.power += std::norm(amplitudes[i]);
    }
  }
  return sums;
}

Sums sum_of(const Paths& paths, double wavenumber, double distance, Job* job) {
  const Replayer replayer(paths, paths.radar);
  const int64_t num_blocks = (paths.num_paths() + kPathsPerBlock - 1) / kPathsPerBlock;
  std::vector<Sums> blocks(static_cast<size_t>(num_blocks));
  parallel_for(num_blocks, [&](int64_t i) {
    if (job) job->throw_if_cancelled();
    const int64_t begin = i * kPathsPerBlock, end = std::min(paths.num_paths(), begin + kPathsPerBlock);
    blocks[static_cast<size_t>(i)] = sum_block(paths, replayer, wavenumber, distance, begin, end);
  });
  Sums sums;
  for (const Sums& block : blocks) {
    sums.field += block.field;
    sums.power += block.power;
  }
  return sums;
}

}  // namespace

void RcsSettings::validate() const {
  require(std::isfinite(frequency) && frequency > 0, "frequency", "must be finite and > 0 Hz", frequency);
  const double length = polarization.norm();
  require(std::isfinite(length) && length > 0, "polarization", "must be finite and not zero, length", length);
  tracing_of(*this).validate();
}

std::vector<RadarCrossSection> rcs(const Scene& scene, std::span<const RcsDirections> directions,
                                   const RcsSettings& settings, Job* job) {
  settings.validate();
  const Target target = target_of(scene);
  const double wavenumber = kTwoPi * settings.frequency / kSpeedOfLight;
  const double distance = far_distance(target, wavenumber);
  std::vector<Radar> radars;
  for (const RcsDirections& pair : directions) radars.push_back(far_radar(target, pair, distance, settings));

  const TraceSettings tracing = tracing_of(settings);
  if (job) job->start(static_cast<int64_t>(radars.size()));
  std::vector<RadarCrossSection> out;
  for (const Radar& radar : radars) {
    if (job) job->throw_if_cancelled();
    // With one direction the progress is that of its trace, else by directions.
    const Paths paths = trace(scene, radar, tracing, radars.size() == 1 ? job : nullptr);
    const Sums sums = sum_of(paths, wavenumber, distance, job);
    // (4 pi)^3 R^4 / lambda^2 for Q^2 = 1 W
    const double scale = std::pow(4.0 * kPi, 3) * std::pow(distance, 4) * std::pow(wavenumber / kTwoPi, 2);
    out.push_back({std::norm(sums.field) * scale, sums.power * scale});
    if (job && radars.size() > 1) job->advance(1);
  }
  return out;
}

}  // namespace echopath
