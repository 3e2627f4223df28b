#include "echopath/trace/tracer.h"

#include <algorithm>
#include <iterator>

#include "echopath/base/constants.h"
#include "echopath/base/memory/machine_memory.h"
#include "echopath/base/text/streamed.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/record/blocks/record_in_parts.h"
#include "echopath/record/blocks/record_writer.h"
#include "echopath/trace/mirrors/mirror_paths.h"
#include "echopath/trace/sheets/passes.h"
#include "echopath/trace/strata/surface_scatterers.h"

namespace echopath {
namespace {

constexpr int64_t kRaysPerBlock = 256;
static_assert(kRaysPerBlock % kPacketSize == 0, "a packet has rays of one kind (LaunchPlan::first_point)");
// These blocks are shot before they become part of the record: few enough for the caches, and many for each thread.
constexpr int64_t kBlocksPerWave = 24, kBlocksPerThread = 12;
constexpr int64_t kPathsPerPart = 1 << 18;  // of a record that is filtered
constexpr int64_t kBlocksAhead = 64;        // they tell how large a record of several waves will be

// Sets the whole sphere, or the half space in front where all antennas look the same way and have no gain behind. Receivers
// count as transmitters do where there may be several bounces, for a way that reaches one from behind is traced from its
// other end.
void set_field_of_view(const Radar& radar, const Transform& world_from_radar, int max_bounces, LaunchSettings& launch) {
  const auto boresight = [&](const Antenna& antenna) { return in_world(antenna, Vec3::UnitX(), world_from_radar); };
  launch.boresight = boresight(radar.transmitters.front());
  const auto looks_ahead = [&](const Antenna& antenna) {
    return antenna.pattern.is_dark_behind() && boresight(antenna).dot(launch.boresight) >= 1.0 - 1e-9;
  };
  const bool is_of_receivers = max_bounces > 1;
  if (!std::ranges::all_of(radar.transmitters, looks_ahead)) return;
  if (!is_of_receivers || std::ranges::all_of(radar.receivers, looks_ahead)) launch.field_versine = 1.0;
}

TraceFrame make_frame(const Radar& radar, const TraceSettings& settings) {
  TraceFrame frame;
  static_cast<RecordSettings&>(frame) = settings;
  frame.start_time = settings.start_time;
  frame.trace_time = radar.middle_of_frame(settings.start_time);
  const Transform world_from_radar = radar.world_from_radar(frame.trace_time);
  frame.transmitter = mean_position(radar.transmitters, world_from_radar);
  frame.receiver = mean_position(radar.receivers, world_from_radar);
  return frame;
}

Paths empty_record(const SceneSnapshot& scene, const Radar& radar, const TraceSettings& settings) {
  settings.validate();
  radar.validate();
  scene->require_times(settings.start_time, settings.start_time + radar.frame_duration());
  Paths paths;
  paths.scene = scene.shared();
  paths.radar = radar;
  paths.frame = make_frame(radar, settings);
  return paths;
}

std::vector<const PathBlock*> pointers_to(const std::vector<PathBlock>& blocks) {
  std::vector<const PathBlock*> pointers;
  for (const PathBlock& block : blocks) pointers.push_back(&block);
  return pointers;
}

EmbreeScene::Upkeep upkeep_of(const Radar& radar, const TraceSettings& settings) {
  if (settings.for_edits) return EmbreeScene::Upkeep::kEdits;
  return EmbreeScene::upkeep_near(radar.is_moving());
}

// What may be elsewhere in the next record must not change over which mirrors others are lit: rays that are kept have asked
// about these alone, and what stands still is aimed at over these in all frames.
ShadowCasters casters_of(const Scene& scene, const Radar& radar, const TraceSettings& settings) {
  if (!settings.for_edits)
    return has_steady_rays(scene, radar, settings.scatterers) ? scene.still_meshes() : ShadowCasters{};
  ShadowCasters mirrors;
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) mirrors.push_back(scene.node_of(id).material->mirror);
  return mirrors;
}

}  // namespace

Tracer::Tracer(const SceneSnapshot& scene, const Radar& radar, const TraceSettings& settings, Job* job, KeptGeometry* kept,
               FittedStrata* fitted)
    : empty_(empty_record(scene, radar, settings)), num_rays_to_come_(settings.num_rays_to_come),
      pose_(*empty_.scene, empty_.frame.trace_time), world_from_radar_(radar.world_from_radar(empty_.frame.trace_time)),
      loan_(kept, *empty_.scene, pose_, empty_.frame.transmitter, upkeep_of(radar, settings), job), geometry_(*loan_),
      origin_(geometry_.origin()), edge_estimate_(empty_.radar, world_from_radar_, origin_),
      mirrors_(find_mirrors(*empty_.scene, geometry_)), sbr_(settings_of_rays(settings)),
      frusta_(
          find_antenna_frusta(*empty_.scene, geometry_, mirrors_, sbr_, casters_of(*empty_.scene, radar, settings), job)),
      plan_(plan_rays(settings, fitted, job)), shooter_(*empty_.scene, geometry_, mirrors_, plan_, sbr_, frusta_) {
  aim_at_points(settings, job);
  if (!plan_.first_number.empty()) pieces_ = plan_.pieces(kRaysPerBlock);
  pose_edges();
  empty_.frame.strata = plan_.strata;
  empty_.frame.statistics.num_rays = num_rays();
  empty_.frame.statistics.num_unaimed = plan_.num_unaimed;
  empty_.frame.statistics.num_unfollowed_frusta = frusta_.num_unfollowed();
}

LaunchPlan Tracer::plan_rays(const TraceSettings& settings, FittedStrata* fitted, const Job* job) {
  LaunchSettings launch;
  launch.num_rays = settings.num_rays;
  launch.seed = settings.seed;
  launch.sampler = settings.sampler;
  launch.batches = settings.batches;
  launch.guide = settings.guide;
  launch.fitted = fitted;
  launch.job = job;
  launch.by_object = settings.for_edits;
  launch.by_name = settings.for_edits || settings.scatterers == Scatterers::kSurface;
  launch.is_steady = has_steady_rays(*empty_.scene, empty_.radar, settings.scatterers);
  launch.frusta = with_at_most(frusta_.transmitter, most_leg_mirrors(sbr_));
  launch.transmitter = empty_.frame.transmitter - origin_;
  set_field_of_view(empty_.radar, world_from_radar_, settings.max_bounces, launch);
  return plan_launch(*empty_.scene, geometry_, mirrors_, launch);
}

SbrSettings Tracer::settings_of_rays(const TraceSettings& settings) const {
  SbrSettings sbr;
  sbr.max_bounces = settings.max_bounces;
  sbr.is_polarized = settings.polarization == PolarizationModel::kJones;
  sbr.finds_edges = settings.edges;
  sbr.seed = settings.seed;
  sbr.frequency = empty_.radar.waveform.start_frequency;
  sbr.transmitter = empty_.frame.transmitter - origin_;
  sbr.receiver = empty_.frame.receiver - origin_;
  sbr.polarization = empty_.mode_polarization();
  return sbr;
}

void Tracer::aim_at_points(const TraceSettings& settings, Job* job) {
  if (settings.scatterers != Scatterers::kSurface) return;
  plan_.first_point = num_lattice_blocks() * kRaysPerBlock;
  plan_.surface_scatterers =
      find_surface_scatterers(*empty_.scene, geometry_, plan_, {settings.seed, sbr_.frequency, sbr_.transmitter}, job);
}

PlaneImages Tracer::plane_images() const {
  const auto first = [&](const std::vector<Antenna>& antennas) {
    return posed_antennas(antennas, world_from_radar_, origin_).front();
  };
  return {*empty_.scene, geometry_, sbr_, first(empty_.radar.transmitters), first(empty_.radar.receivers)};
}

void Tracer::pose_edges() {
  if (!empty_.frame.edges) return;
  edges_ = posed_edges(*empty_.scene, pose_, origin_);
  least_edge_power_ = least_edge_power(strongest_of(edges_, *empty_.scene, edge_estimate_), empty_.radar);
}

int64_t Tracer::num_lattice_blocks() const { return num_chunks(num_rays(), kRaysPerBlock); }

int64_t Tracer::num_blocks() const {
  if (!pieces_.empty()) return std::ssize(pieces_);
  return num_lattice_blocks() + num_chunks(std::ssize(plan_.surface_scatterers), kRaysPerBlock);
}

void Tracer::shoot_block(int64_t index, PathBlock& block) const {
  if (!pieces_.empty()) {
    const auto& [begin, end] = pieces_[index];
    return shoot(begin, end, block);
  }
  const int64_t end = index < num_lattice_blocks() ? num_rays() : plan_.first_point + std::ssize(plan_.surface_scatterers);
  shoot(index * kRaysPerBlock, std::min(end, (index + 1) * kRaysPerBlock), block);
}

std::vector<PathBlock> Tracer::find_paths_without_rays(Job* job) const {
  std::vector<PathBlock> blocks = find_mirror_paths(geometry_, mirrors_, sbr_, frusta_, job);
  if (!empty_.frame.edges) return blocks;
  std::vector<PathBlock> of_edges = find_edge_paths(edge_query(), job);
  std::move(of_edges.begin(), of_edges.end(), std::back_inserter(blocks));
  return blocks;
}

LitPlanes Tracer::lit_planes() const { return {*empty_.scene, geometry_, kSpeedOfLight / sbr_.frequency}; }

std::vector<PathBlock> Tracer::find_edges(LitPlanes& lit, Job* job) const {
  if (!empty_.frame.edges) return {};
  lit.finish((sbr_.receiver - sbr_.transmitter).norm());
  return find_edges_over_planes(edge_query(), lit, job);
}

// Shoots every `step`-th block.
std::vector<PathBlock> Tracer::shoot_ahead(int64_t step, Job* job) const {
  std::vector<PathBlock> ahead(num_chunks(num_blocks(), step));
  Job own(job);  // its progress is that of the waves
  parallel_for(std::ssize(ahead), [&](int64_t i) { shoot_block(i * step, ahead[i]); }, &own);
  return ahead;
}

// Returns the blocks [begin, begin + wave.size()), as far as there are so many: it takes those that were shot ahead and
// shoots the others into `wave`.
std::vector<const PathBlock*> Tracer::shoot_wave(int64_t begin, const std::vector<PathBlock>& ahead, int64_t step,
                                                 std::vector<PathBlock>& wave, Job* job) const {
  std::vector<const PathBlock*> blocks(std::min(std::ssize(wave), num_blocks() - begin));
  const auto shoot = [&](int64_t k) {
    const int64_t index = begin + k;
    const bool is_ahead = !ahead.empty() && index % step == 0;
    PathBlock& own = wave[k];
    blocks[k] = is_ahead ? &ahead[index / step] : &own;
    if (is_ahead) return;
    own.clear();
    shoot_block(index, own);
  };
  parallel_for(std::ssize(blocks), shoot, job);
  return blocks;
}

// Returns how much of the paths of these blocks a filter leaves.
double Tracer::kept_share(const std::vector<PathBlock>& blocks, const RecordFilter& filter, Job* job) const {
  Paths paths = empty_;
  RecordWriter record(paths);
  record.append(pointers_to(blocks), job);
  record.finish();
  const auto num_all = static_cast<double>(paths.num_paths());
  Job own(job);
  return static_cast<double>(filter(std::move(paths), &own).num_paths()) / num_all;
}

// Raises invalid_argument where the machine has no memory for the record, or for that of the trace which this one prepares.
void Tracer::require_memory(const std::vector<PathBlock>& ahead, const RecordFilter& filter, Job* job) const {
  const int64_t most_rays = std::max(num_rays(), num_rays_to_come_);
  double needed = RecordWriter::num_bytes(ahead, num_chunks(most_rays, kRaysPerBlock));
  const auto there = static_cast<double>(machine_memory());
  if (needed > there && filter) needed *= kept_share(ahead, filter, job);
  if (needed <= there) return;
  require(false, "num_rays",
          streamed("must be so few that their paths, about ", std::llround(needed / 1e9),
                   " GB, fit into the memory of this machine, ", std::llround(there / 1e9), " GB"),
          most_rays);
}

// Shoots in waves: the blocks are still in the cache when they become part of the record, and the next wave uses their
// memory.
Paths Tracer::run(Job* job, PlaneDoubles* doubles, const RecordFilter& filter) const {
  Job of_filter(job);  // its progress is not that of the rays
  const SheetPasses passes(*empty_.scene, empty_.frame.trace_time, geometry_.rounding(), job);
  const auto finished = [&](Paths part) {
    passes.add_to(part, job);
    if (filter) part = filter(std::move(part), &of_filter);
    return part;
  };
  RecordInParts record(empty_, filter ? std::optional(kPathsPerPart) : std::nullopt, finished);
  const std::vector<PathBlock> without_rays = find_paths_without_rays(job);
  record.append(pointers_to(without_rays), job);
  if (job) job->start(num_blocks());
  std::vector<PathBlock> ahead, wave(static_cast<size_t>(std::max(kBlocksPerWave, kBlocksPerThread * num_threads())));
  const int64_t step = (num_blocks() + kBlocksAhead - 1) / kBlocksAhead;
  if (num_blocks() > std::ssize(wave)) ahead = shoot_ahead(step, job);
  require_memory(ahead, filter, job);
  record.expect(ahead, num_blocks());
  PlaneImages images = plane_images();
  LitPlanes lit = lit_planes();
  for (int64_t begin = 0; begin < num_blocks(); begin += std::ssize(wave)) {
    const std::vector<const PathBlock*> blocks = shoot_wave(begin, ahead, step, wave, job);
    for (const PathBlock* block : blocks) {
      images.add_chains(*block);
      lit.add_chains(*block);
    }
    record.append(blocks, job);
  }
  const PathBlock over_planes = images.find(job);
  const std::vector<PathBlock> of_edges = find_edges(lit, job);
  record.append({&over_planes}, job);
  record.append(pointers_to(of_edges), job);
  Paths paths = record.take();
  images.doubles().leave_out(paths, job);
  if (doubles) *doubles = images.doubles();
  if (filter && images.doubles().any()) return paths.with_own_hits(job);
  return paths;
}

}  // namespace echopath
