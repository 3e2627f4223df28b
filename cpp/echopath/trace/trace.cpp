#include "echopath/trace/trace.h"

#include <cmath>

#include "echopath/base/parallel.h"
#include "echopath/trace/mirror_paths.h"

namespace echopath {
namespace {

constexpr int64_t kRaysPerBlock = 1024;

// The whole sphere, or the half space in front where all transmitters look the same way and have no gain behind.
void set_field_of_view(const Radar& radar, const Transform& world_from_radar, LaunchSettings& launch) {
  const auto boresight = [](const Antenna& antenna) -> Vec3 { return antenna.orientation * Vec3::UnitX(); };
  const Vec3 first = boresight(radar.transmitters.front());
  launch.boresight = (world_from_radar.linear() * first).normalized();
  for (const Antenna& antenna : radar.transmitters) {
    if (!antenna.pattern.is_dark_behind() || boresight(antenna).dot(first) < 1.0 - 1e-9) return;
  }
  launch.field_versine = 1.0;
}

TraceFrame make_frame(const Radar& radar, const TraceSettings& settings) {
  TraceFrame frame;
  frame.start_time = settings.start_time;
  frame.trace_time = settings.start_time + 0.5 * radar.frame_duration();
  const Transform world_from_radar = radar.world_from_radar(frame.trace_time);
  frame.transmitter = mean_position(radar.transmitters, world_from_radar);
  frame.receiver = mean_position(radar.receivers, world_from_radar);
  frame.seed = settings.seed;
  frame.max_bounces = settings.max_bounces;
  frame.footprint = settings.footprint;
  frame.sampler = settings.sampler;
  frame.num_batches = settings.batches;
  frame.polarization = settings.polarization;
  return frame;
}

void shoot_all(const RayShooter& shooter, int64_t num_rays, std::vector<PathBlock>& blocks, Job* job) {
  const int64_t num_blocks = (num_rays + kRaysPerBlock - 1) / kRaysPerBlock;
  const size_t base = blocks.size();
  blocks.resize(base + static_cast<size_t>(num_blocks));
  if (job) job->start(num_blocks);
  parallel_for(
      num_blocks,
      [&](int64_t i) {
        const int64_t end = std::min(num_rays, (i + 1) * kRaysPerBlock);
        PathBlock& block = blocks[base + static_cast<size_t>(i)];
        for (int64_t ray = i * kRaysPerBlock; ray < end; ++ray) shooter.shoot(ray, block);
        block.shrink_to_fit();
      },
      job);
}

}  // namespace

void TraceSettings::validate() const {
  require(num_rays >= 1, "num_rays", "must be >= 1", num_rays);
  require(max_bounces >= 1 && max_bounces <= 64, "max_bounces", "must lie in [1, 64]", max_bounces);
  require(std::isfinite(start_time), "start_time", "must be finite", start_time);
  require(batches >= 1 && batches <= 64, "batches", "must lie in [1, 64]", batches);
}

Paths trace(const Scene& scene, const Radar& radar, const TraceSettings& settings, Job* job) {
  settings.validate();
  radar.validate();
  scene.require_times(settings.start_time, settings.start_time + radar.frame_duration());

  Paths paths;
  paths.scene = std::make_shared<const Scene>(scene);
  paths.radar = radar;
  paths.frame = make_frame(radar, settings);
  const Pose pose(*paths.scene, paths.frame.trace_time);
  const Vec3 origin = EmbreeScene::origin_near(*paths.scene, pose, paths.frame.transmitter);
  const EmbreeScene geometry(*paths.scene, pose, origin, job);
  const std::vector<Mirror> mirrors = find_mirrors(*paths.scene, geometry);

  const Transform world_from_radar = radar.world_from_radar(paths.frame.trace_time);
  LaunchSettings launch;
  launch.num_rays = settings.num_rays;
  launch.seed = settings.seed;
  launch.sampler = settings.sampler;
  launch.batches = settings.batches;
  launch.max_image_mirrors = std::min(kMaxLegMirrors, settings.max_bounces - 1);
  launch.transmitter = paths.frame.transmitter - origin;
  set_field_of_view(radar, world_from_radar, launch);
  const LaunchPlan plan = plan_launch(*paths.scene, geometry, mirrors, launch);
  paths.frame.strata = plan.strata;

  SbrSettings sbr;
  sbr.max_bounces = settings.max_bounces;
  sbr.is_polarized = settings.polarization == PolarizationModel::kJones;
  sbr.seed = settings.seed;
  sbr.frequency = radar.waveform.start_frequency;
  sbr.transmitter = launch.transmitter;
  sbr.receiver = paths.frame.receiver - origin;
  const Antenna& first = radar.transmitters.front();
  sbr.polarization = (world_from_radar.linear() * (first.orientation * first.polarization)).normalized();

  std::vector<PathBlock> blocks(1);
  add_mirror_paths(geometry, *paths.scene, mirrors, sbr, blocks.front());
  const RayShooter shooter(*paths.scene, geometry, mirrors, plan, sbr);
  paths.frame.statistics.num_rays = plan.first_ray.back();
  shoot_all(shooter, plan.first_ray.back(), blocks, job);
  join_blocks(blocks, paths, job);
  return paths;
}

}  // namespace echopath
