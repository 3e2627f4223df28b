#include "echopath/replay/replay.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/base/errors.h"
#include "echopath/base/parallel.h"
#include "echopath/replay/evaluate_chains.h"
#include "echopath/replay/motion_knots.h"
#include "echopath/replay/node_tails.h"

namespace echopath {
namespace {

constexpr std::array<int, 10> kOrders = {4, 6, 8, 10, 12, 14, 16, 20, 24, 32};
constexpr size_t kStaticLevel = 0;

// Coefficients fall about geometrically from these: orders above what that makes of a tail are the next to try.
constexpr double kFirstPhase = 100.0;     // rad
constexpr double kFirstAmplitude = 1.0;   // relative to the largest

// The order at which a tail found at `order` would be within its tolerance.
double order_for(double tolerance, double tail, double first, int order) {
  if (tail >= first) return kOrders.back();
  return order * std::log(tolerance / first) / std::log(tail / first);
}

}  // namespace

// Instants of one choice of nodes; made once, used by all blocks.
struct Replayer::Level {
  FrameNodes nodes;
  std::vector<Instant> instants;
  NodePoses poses;

  LevelView view() const { return {instants, poses}; }
  void find_poses(const Scene& scene) { poses = node_poses(instants, static_cast<uint32_t>(scene.meshes().size())); }
};

// Memory of one block, kept for the next.
struct Replayer::Workspace {
  ChainEvaluation evaluate_chains;
};

namespace {

void to_delays(std::vector<Echoes>& lengths) {
  for (Echoes& channel : lengths) {
    for (double& value : channel.delay) value /= kSpeedOfLight;
  }
}

}  // namespace

Replayer::Replayer(const Paths& paths, const Radar& radar, const ReplaySettings& settings)
    : paths_(paths), radar_(radar), settings_(settings), localise_(paths, hit_patches(paths)) {
  radar.validate();
  require(settings.phase_tolerance > 0, "phase_tolerance", "must be positive", settings.phase_tolerance);
  paths.scene->require_times(paths.frame.start_time, paths.frame.start_time + radar.frame_duration());
  radio_ = radio_constants(paths, radar);
  radio_.specular = settings.specular;
  antennas_have_phase_ = has_phase(radar);
  for (uint32_t id = 0; id < paths.scene->meshes().size(); ++id) mesh_moves_.push_back(paths.scene->is_moving(id));
  find_shapes();
  levels_.resize(1 + shapes_.size() + radar.transmitters.size());
}

Replayer::~Replayer() = default;

int Replayer::num_channels() const { return static_cast<int>(radar_.transmitters.size() * radar_.receivers.size()); }

bool Replayer::is_static(int64_t path) const {
  if (radar_.motion) return false;
  const Hit* hits = paths_.hits_of(path);
  const int count = paths_.num_bounces[static_cast<size_t>(path)];
  return std::none_of(hits, hits + count, [&](const Hit& hit) { return mesh_moves_[hit.mesh_id] != 0; });
}

// Nodes in a chirp: value and slope in its middle, or its delay throughout.
int Replayer::exact_order() const { return settings_.per_sample ? 5 : 3; }

int64_t Replayer::num_exact_nodes() const { return int64_t{radar_.waveform.num_chirps} * exact_order(); }

// Orders over whole smooth pieces and over those between knots, by the number of nodes; nothing is posed for those that cost
// more than evaluation in every chirp.
void Replayer::find_shapes() {
  if (settings_.exact) return;
  breakpoints_ = motion_breakpoints(*paths_.scene, radar_);
  knots_ = motion_knots(*paths_.scene, radar_);
  for (const int order : kOrders) {
    shapes_.push_back({order, &breakpoints_});
    if (num_nodes({1, &knots_}) > num_nodes({1, &breakpoints_})) shapes_.push_back({order, &knots_});
  }
  std::erase_if(shapes_, [&](const LevelShape& shape) { return num_nodes(shape) > num_exact_nodes(); });
  std::stable_sort(shapes_.begin(), shapes_.end(),
                   [&](const LevelShape& a, const LevelShape& b) { return num_nodes(a) < num_nodes(b); });
}

int64_t Replayer::num_nodes(const LevelShape& shape) const {
  return shape.order * num_pieces(radar_, paths_.frame.start_time, *shape.cuts);
}

Instant Replayer::instant(double time) const {
  return Instant(*paths_.scene, radar_, localise_.patches(), paths_.frame.transmitter, time);
}

FrameNodes Replayer::nodes_of(size_t index) const {
  const ChirpDerivatives derivatives = settings_.per_sample ? ChirpDerivatives::kThird : ChirpDerivatives::kFirst;
  const double start = paths_.frame.start_time;
  if (index == kStaticLevel) return static_nodes(radar_, paths_.frame.trace_time);
  if (index > shapes_.size()) {
    return exact_nodes(radar_, start, exact_order(), static_cast<int>(index - shapes_.size() - 1), derivatives);
  }
  const LevelShape& shape = shapes_[index - 1];
  return chebyshev_nodes(radar_, start, *shape.cuts, shape.order, derivatives);
}

// Behind the polynomials comes a level for each transmitter, which knows that one alone.
const Replayer::Level& Replayer::level(size_t index) const {
  const std::lock_guard lock(levels_mutex_);
  std::unique_ptr<const Level>& slot = levels_[index];
  if (slot) return *slot;
  auto made = std::make_unique<Level>();
  made->nodes = nodes_of(index);
  for (const double time : made->nodes.times) {
    Instant& posed = made->instants.emplace_back(instant(time));
    if (index > shapes_.size()) posed.transmitters = {posed.transmitters[index - shapes_.size() - 1]};
  }
  made->find_poses(*paths_.scene);
  slot = std::move(made);
  return *slot;
}

std::unique_ptr<Replayer::Workspace> Replayer::take_workspace() const {
  const std::lock_guard lock(workspaces_mutex_);
  if (workspaces_.empty()) return std::make_unique<Workspace>();
  std::unique_ptr<Workspace> last = std::move(workspaces_.back());
  workspaces_.pop_back();
  return last;
}

void Replayer::give_back(std::unique_ptr<Workspace> workspace) const {
  const std::lock_guard lock(workspaces_mutex_);
  workspaces_.push_back(std::move(workspace));
}

// Lengths in m in the place of delays.
std::vector<Echoes> Replayer::at_nodes(std::span<const int64_t> paths, const Level& level) const {
  const size_t num_nodes = level.instants.size();
  const size_t channels = level.instants.front().transmitters.size() * radar_.receivers.size();
  std::vector<Echoes> out(channels);
  std::vector<ChannelNodes> to;
  for (size_t channel = 0; channel < channels; ++channel) {
    Echoes& echoes = out[channel];
    if (!level.nodes.sampling.empty()) echoes.sampling = level.nodes.sampling[channel / radar_.receivers.size()];
    echoes.num_echoes = static_cast<int64_t>(paths.size());
    echoes.delay.resize(num_nodes * paths.size());
    echoes.amplitude.resize(num_nodes * paths.size());
    to.push_back({echoes.delay.data(), echoes.amplitude.data()});
  }
  const ChainPlan plan = antennas_have_phase_ ? unshared(paths.size()) : plan_chains(paths_, localise_, settings_.specular, paths);
  std::unique_ptr<Workspace> workspace = take_workspace();
  workspace->evaluate_chains(plan, localise_, level.view(), radio_, paths.size(), to);
  give_back(std::move(workspace));
  evaluate_one_by_one(paths, plan.others, level.instants, out);
  return out;
}

void Replayer::evaluate_one_by_one(std::span<const int64_t> paths, std::span<const size_t> places,
                                   std::span<const Instant> instants, std::vector<Echoes>& lengths) const {
  std::vector<int64_t> indices;
  for (const size_t place : places) indices.push_back(paths[place]);
  const LocalPaths block = localise_(indices);
  EvaluationScratch scratch(block.longest);
  std::vector<double> length(lengths.size());
  std::vector<std::complex<double>> amplitude(lengths.size());
  for (size_t i = 0; i < places.size(); ++i) {
    for (size_t node = 0; node < instants.size(); ++node) {
      evaluate_path(block.paths[i], instants[node], radio_, scratch, {length.data(), amplitude.data(), 1});
      for (size_t channel = 0; channel < lengths.size(); ++channel) {
        lengths[channel].delay[node * paths.size() + places[i]] = length[channel];
        lengths[channel].amplitude[node * paths.size() + places[i]] = amplitude[channel];
      }
    }
  }
}

std::vector<Echoes> Replayer::still(std::span<const int64_t> indices) const {
  std::vector<Echoes> echoes = at_nodes(indices, level(kStaticLevel));
  to_delays(echoes);
  return echoes;
}

std::vector<Echoes> Replayer::exact(std::span<const int64_t> indices, int transmitter) const {
  std::vector<Echoes> echoes = at_nodes(indices, level(exact_level(transmitter)));
  to_delays(echoes);
  return echoes;
}

void Replayer::forget_exact(int transmitter) const {
  const std::lock_guard lock(levels_mutex_);
  levels_[exact_level(transmitter)].reset();
}

std::vector<Echoes> Replayer::interpolated(std::span<const int64_t> indices, int index, std::vector<FailedPath>& failed) const {
  const Level& polynomial = level(static_cast<size_t>(index));
  std::vector<Echoes> echoes = at_nodes(indices, polynomial);
  std::vector<double> needed(indices.size());  // order
  for (const Echoes& channel : echoes) raise_orders(polynomial.nodes, channel, needed);
  for (size_t p = 0; p < indices.size(); ++p) {
    if (needed[p] == 0.0) continue;
    failed.push_back({indices[p], next_level(index, needed[p])});
    for (Echoes& channel : echoes) {
      for (size_t i = p; i < channel.amplitude.size(); i += indices.size()) channel.amplitude[i] = 0.0;
    }
  }
  to_delays(echoes);
  return echoes;
}

// Orders that paths of one channel would need which the polynomials do not follow.
void Replayer::raise_orders(const FrameNodes& nodes, const Echoes& lengths, std::vector<double>& needed) const {
  const NodeTails tails = node_tails(nodes, lengths);
  for (size_t p = 0; p < needed.size(); ++p) {
    const double phase = radio_.wavenumber * tails.length[p], amplitude = tails.amplitude[p];
    if (phase <= settings_.phase_tolerance && amplitude <= settings_.amplitude_tolerance) continue;
    needed[p] = std::max({needed[p], order_for(settings_.phase_tolerance, phase, kFirstPhase, nodes.order),
                          order_for(settings_.amplitude_tolerance, amplitude, kFirstAmplitude, nodes.order)});
  }
}

// The first after `index` of at least that order; where the motions have knots, any that keeps them apart will do.
int Replayer::next_level(int index, double needed_order) const {
  const std::vector<double>* cuts = shapes_[static_cast<size_t>(index - 1)].cuts;
  for (size_t next = static_cast<size_t>(index); next < shapes_.size(); ++next) {
    const LevelShape& shape = shapes_[next];
    if (shape.order >= needed_order || shape.cuts != cuts) return static_cast<int>(next) + 1;
  }
  return num_levels() + 1;
}

// The distances of vertices all over a mesh from the transmitters tell how many nodes its motion needs: an echo's length is
// made of such distances.
bool Replayer::fits(const Level& level, uint32_t mesh_id) const {
  const Node& node = paths_.scene->node_of(mesh_id);
  const auto vertices_at = [&](const Instant& instant) -> const std::vector<Vec3>& {
    return node.deformation ? instant.deformed_vertices(mesh_id) : node.mesh->vertices();
  };
  const size_t num_vertices = vertices_at(level.instants.front()).size();
  const size_t step = std::max<size_t>(1, num_vertices / 16);
  for (size_t vertex = 0; vertex < num_vertices; vertex += step) {
    std::vector<double> distance;
    for (const Instant& instant : level.instants) {
      const Vec3 point = instant.rotation(mesh_id) * vertices_at(instant)[vertex] + instant.translation(mesh_id);
      distance.push_back(2.0 * (point - instant.transmitters.front().position).norm());
    }
    if (radio_.wavenumber * tail_of(level.nodes, distance) > settings_.phase_tolerance) return false;
  }
  return true;
}

void Replayer::find_mesh_levels() const {
  const int most = num_levels();
  for (uint32_t id = 0; id < mesh_moves_.size(); ++id) {
    int& needed = mesh_level_.emplace_back(1);
    if (mesh_moves_[id] == 0 && !radar_.motion) continue;
    while (needed <= most && !fits(level(static_cast<size_t>(needed)), id)) ++needed;
  }
}

int Replayer::first_level(int64_t path) const {
  std::call_once(mesh_levels_made_, [&] { find_mesh_levels(); });
  const Hit* hits = paths_.hits_of(path);
  int needed = 1;
  for (int k = 0; k < paths_.num_bounces[static_cast<size_t>(path)]; ++k) needed = std::max(needed, mesh_level_[hits[k].mesh_id]);
  return needed;
}

void Replayer::evaluate(std::span<const int64_t> indices, double time, std::vector<double>& lengths,
                        std::vector<std::complex<double>>& amplitudes, Job* job) const {
  constexpr size_t kBlock = 8192;
  Level single;
  single.instants.push_back(instant(time));
  single.find_poses(*paths_.scene);
  const auto channels = static_cast<size_t>(num_channels());
  lengths.resize(channels * indices.size());
  amplitudes.resize(channels * indices.size());
  parallel_for(static_cast<int64_t>((indices.size() + kBlock - 1) / kBlock), [&](int64_t i) {
    const size_t begin = static_cast<size_t>(i) * kBlock, size = std::min(kBlock, indices.size() - begin);
    const std::vector<Echoes> values = at_nodes(indices.subspan(begin, size), single);
    for (size_t channel = 0; channel < channels; ++channel) {
      const auto to = static_cast<ptrdiff_t>(channel * indices.size() + begin);
      std::copy_n(values[channel].delay.begin(), size, lengths.begin() + to);
      std::copy_n(values[channel].amplitude.begin(), size, amplitudes.begin() + to);
    }
  }, job);
}

}  // namespace echopath
