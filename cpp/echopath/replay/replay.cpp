#include "echopath/replay/replay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "echopath/base/constants.h"
#include "echopath/base/errors.h"
#include "echopath/base/parallel.h"
#include "echopath/base/simd.h"
#include "echopath/replay/evaluate_chains.h"
#include "echopath/replay/motion_knots.h"
#include "echopath/replay/node_tails.h"

namespace echopath {
namespace {

constexpr std::array<int, 10> kOrders = {4, 6, 8, 10, 12, 14, 16, 20, 24, 32};
constexpr size_t kStaticLevel = 0;
// Paths whose legs and what these are made of stay in the second-level cache.
constexpr size_t kPlannedTogether = 2000;
// Amplitudes in this many chirps cost as much as one more node, with what a level costs that is tried in vain.
constexpr int64_t kWorthOfANode = 8;

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
  ChainPlanner plan_chains;
  ChainEvaluation evaluate_chains;
};

namespace {

ECHOPATH_INLINE void add_weighted(const double* values, double weight, size_t count, double* __restrict sum) {
  for (size_t i = 0; i < count; ++i) sum[i] += weight * values[i];
}

// Echoes at derivative_sampling nodes: with the lengths that a polynomial has at the chirps, and amplitudes that stand there.
void join_chirps(const Echoes& polynomial, const Echoes& centres, Echoes& out) {
  const auto count = static_cast<size_t>(polynomial.num_echoes), stride = static_cast<size_t>(out.sampling.order);
  const TimeSampling& from = polynomial.sampling;
  const auto order = static_cast<size_t>(from.order);
  const std::vector<double>* const weights[] = {&from.value, &from.slope, &from.bend, &from.twist};
  out.num_echoes = polynomial.num_echoes;
  out.group.clear();
  out.delay.assign(static_cast<size_t>(out.sampling.num_nodes) * count, 0.0);
  out.amplitude.assign(out.delay.size(), 0.0);
  for (size_t chirp = 0; chirp < from.first_node.size(); ++chirp) {
    std::copy_n(centres.amplitude.data() + chirp * count, count, out.amplitude.data() + chirp * stride * count);
    const double* first = polynomial.delay.data() + static_cast<size_t>(from.first_node[chirp]) * count;
    for (size_t d = 0; d < stride; ++d) {
      double* to = out.delay.data() + (chirp * stride + d) * count;
      for (size_t k = 0; k < order; ++k) run_simd<add_weighted>(first + k * count, (*weights[d])[chirp * order + k], count, to);
    }
  }
}

std::vector<size_t> all_places(size_t count) {
  std::vector<size_t> places(count);
  std::iota(places.begin(), places.end(), size_t{0});
  return places;
}

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
  levels_.resize(1 + shapes_.size() + 2 * radar.transmitters.size());
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
  const double start = paths_.frame.start_time;
  if (index == kStaticLevel) return static_nodes(radar_, paths_.frame.trace_time);
  if (index >= centre_level(0)) return centre_nodes(radar_, start, static_cast<int>(index - centre_level(0)));
  if (index >= exact_level(0)) {
    return exact_nodes(radar_, start, exact_order(), static_cast<int>(index - exact_level(0)), derivatives());
  }
  const LevelShape& shape = shapes_[index - 1];
  return chebyshev_nodes(radar_, start, *shape.cuts, shape.order, derivatives());
}

// Behind the polynomials come two levels for each transmitter, which know that one alone.
const Replayer::Level& Replayer::level(size_t index) const {
  const std::lock_guard lock(levels_mutex_);
  std::unique_ptr<const Level>& slot = levels_[index];
  if (slot) return *slot;
  auto made = std::make_unique<Level>();
  made->nodes = nodes_of(index);
  for (const double time : made->nodes.times) {
    Instant& posed = made->instants.emplace_back(instant(time));
    if (index >= exact_level(0)) {
      posed.transmitters = {posed.transmitters[(index - exact_level(0)) % radar_.transmitters.size()]};
    }
  }
  made->find_poses(*paths_.scene);
  slot = std::move(made);
  return *slot;
}

std::unique_ptr<Replayer::Workspace> Replayer::take_workspace() const {
  const std::lock_guard lock(workspaces_mutex_);
  if (workspaces_.empty()) return std::make_unique<Workspace>(Workspace{ChainPlanner(paths_, localise_, settings_.specular), {}});
  std::unique_ptr<Workspace> last = std::move(workspaces_.back());
  workspaces_.pop_back();
  return last;
}

void Replayer::give_back(std::unique_ptr<Workspace> workspace) const {
  const std::lock_guard lock(workspaces_mutex_);
  workspaces_.push_back(std::move(workspace));
}

std::vector<Echoes> Replayer::take_echoes(size_t count) const {
  std::vector<Echoes> echoes(count);
  const std::lock_guard lock(workspaces_mutex_);
  for (Echoes& one : echoes) {
    if (spare_.empty()) break;
    one = std::move(spare_.back());
    spare_.pop_back();
  }
  return echoes;
}

void Replayer::recycle(std::span<Echoes> echoes) const {
  const std::lock_guard lock(workspaces_mutex_);
  for (Echoes& one : echoes) {
    if (!one.delay.empty()) spare_.push_back(std::move(one));
  }
}

// Lengths in m in the place of delays.
std::vector<Echoes> Replayer::at_nodes(std::span<const int64_t> paths, const Level& level, size_t transmitter) const {
  const size_t num_nodes = level.instants.size(), num_receivers = radar_.receivers.size();
  const size_t first = transmitter == kAll ? 0 : transmitter * num_receivers;
  std::vector<Echoes> out = take_echoes(transmitter == kAll ? level.instants.front().transmitters.size() * num_receivers : num_receivers);
  std::vector<ChannelNodes> to;
  for (size_t channel = 0; channel < out.size(); ++channel) {
    Echoes& echoes = out[channel];
    if (!level.nodes.sampling.empty()) echoes.sampling = level.nodes.sampling[(first + channel) / num_receivers];
    else echoes.sampling = {};
    echoes.num_echoes = static_cast<int64_t>(paths.size());
    echoes.group.clear();
    echoes.delay.resize(num_nodes * paths.size());
    echoes.amplitude.resize(num_nodes * paths.size());
    to.push_back({echoes.delay.data(), echoes.amplitude.data(), paths.size(), 0});
  }
  if (antennas_have_phase_) {
    evaluate_one_by_one(paths, all_places(paths.size()), level.instants, {first, to});
    return out;
  }
  std::unique_ptr<Workspace> workspace = take_workspace();
  for (size_t begin = 0; begin < paths.size(); begin += kPlannedTogether) {
    const std::span<const int64_t> part = paths.subspan(begin, std::min(kPlannedTogether, paths.size() - begin));
    for (ChannelNodes& channel : to) channel.first_path = begin;
    const ChainPlan& plan = workspace->plan_chains(part);
    workspace->evaluate_chains(plan, localise_, level.view(), radio_, {first, to});
    evaluate_one_by_one(part, plan.others, level.instants, {first, to});
  }
  give_back(std::move(workspace));
  return out;
}

void Replayer::evaluate_one_by_one(std::span<const int64_t> paths, std::span<const size_t> places,
                                   std::span<const Instant> instants, const ChannelSpan& channels) const {
  if (places.empty()) return;
  std::vector<int64_t> indices;
  for (const size_t place : places) indices.push_back(paths[place]);
  const LocalPaths block = localise_(indices);
  EvaluationScratch scratch(block.longest);
  const size_t num_channels = instants.front().transmitters.size() * instants.front().receivers.size();
  std::vector<double> length(num_channels);
  std::vector<std::complex<double>> amplitude(num_channels);
  for (size_t i = 0; i < places.size(); ++i) {
    for (size_t node = 0; node < instants.size(); ++node) {
      evaluate_path(block.paths[i], instants[node], radio_, scratch, {length.data(), amplitude.data(), 1});
      for (size_t channel = 0; channel < channels.nodes.size(); ++channel) {
        channels.nodes[channel].set(node, places[i], length[channels.first + channel], amplitude[channels.first + channel]);
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

std::vector<Echoes> Replayer::by_chirp(std::span<const int64_t> indices, int index, int transmitter) const {
  std::vector<Echoes> lengths = at_nodes(indices, level(static_cast<size_t>(index)), static_cast<size_t>(transmitter));
  std::vector<Echoes> amplitudes = at_nodes(indices, level(centre_level(transmitter)));
  std::vector<Echoes> echoes = take_echoes(lengths.size());
  for (size_t channel = 0; channel < echoes.size(); ++channel) {
    echoes[channel].sampling = derivative_sampling(radar_.waveform.num_chirps, derivatives());
    join_chirps(lengths[channel], amplitudes[channel], echoes[channel]);
  }
  recycle(lengths);
  recycle(amplitudes);
  to_delays(echoes);
  return echoes;
}

int64_t Replayer::num_nodes_by_chirp() const { return int64_t{radar_.waveform.num_chirps} * (settings_.per_sample ? 4 : 2); }

void Replayer::forget_chirps(int transmitter) const {
  const std::lock_guard lock(levels_mutex_);
  for (const size_t index : {exact_level(transmitter), centre_level(transmitter)}) levels_[index].reset();
}

// Order at which a path's polynomials would follow it, 0 where they do.
struct Replayer::NeededOrder {
  double length = 0.0, amplitude = 0.0;
};

std::vector<Echoes> Replayer::interpolated(std::span<const int64_t> indices, int index, std::vector<FailedPath>& failed) const {
  const Level& polynomial = level(static_cast<size_t>(index));
  std::vector<Echoes> echoes = at_nodes(indices, polynomial);
  std::vector<NeededOrder> needed(indices.size());
  for (const Echoes& channel : echoes) raise_orders(polynomial.nodes, channel, needed);
  for (size_t p = 0; p < indices.size(); ++p) {
    if (needed[p].length == 0.0 && needed[p].amplitude == 0.0) continue;
    failed.push_back(this->failed(indices[p], index, needed[p]));
    for (Echoes& channel : echoes) {
      for (size_t i = p; i < channel.amplitude.size(); i += indices.size()) channel.amplitude[i] = 0.0;
    }
  }
  to_delays(echoes);
  return echoes;
}

// Orders that paths of one channel would need which the polynomials do not follow.
void Replayer::raise_orders(const FrameNodes& nodes, const Echoes& lengths, std::vector<NeededOrder>& needed) const {
  const NodeTails tails = node_tails(nodes, lengths);
  const auto raise = [&](double tolerance, double tail, double first, double& order) {
    if (tail > tolerance) order = std::max(order, order_for(tolerance, tail, first, nodes.order));
  };
  for (size_t p = 0; p < needed.size(); ++p) {
    raise(settings_.phase_tolerance, radio_.wavenumber * tails.length[p], kFirstPhase, needed[p].length);
    raise(settings_.amplitude_tolerance, tails.amplitude[p], kFirstAmplitude, needed[p].amplitude);
  }
}

// Amplitudes that a polynomial follows late or never are left to the chirps.
FailedPath Replayer::failed(int64_t path, int index, const NeededOrder& needed) const {
  const int next = next_level(index, std::max(needed.length, needed.amplitude));
  const bool is_late = next > num_levels() || num_nodes(next) * kWorthOfANode >= radar_.waveform.num_chirps;
  if (needed.length == 0.0 && is_late) return {path, index, true};
  return {path, next, false};
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
