#include "echopath/replay/time/node_levels.h"

#include <algorithm>
#include <array>

#include "echopath/replay/time/motion_knots.h"
#include "echopath/replay/time/node_tails.h"
#include "echopath/replay/evaluate/radio_constants.h"
#include "echopath/replay/time/turn_rates.h"

namespace echopath {
namespace {

constexpr std::array<int, 13> kOrders = {4, 5, 6, 7, 8, 9, 10, 12, 14, 16, 20, 24, NodeLevels::kHighestOrder};

constexpr int kNodesBeyondTurns = 2;  // of a polynomial that follows a turning: where its coefficients begin to fall

// Between neighbours of start, cuts (s, ascending) and end.
double longest_piece(double start, double end, const std::vector<double>& cuts) {
  double longest = 0.0, from = start;
  for (const double cut : cuts) {
    longest = std::max(longest, cut - from);
    from = cut;
  }
  return std::max(longest, end - from);
}

}  // namespace

NodeLevels::NodeLevels(const Paths& paths, const Radar& radar, const ReplaySettings& settings, const Localiser& localise)
    : paths_(paths), radar_(radar), settings_(settings), localise_(localise) {
  find_shapes();
  levels_.resize(1 + shapes_.size() + 2 * radar.transmitters.size());
}

// Nodes in a chirp: value and slope in its middle, or its delay throughout.
int NodeLevels::exact_order() const { return settings_.per_sample ? 5 : 3; }

// Orders over whole smooth pieces and over those between knots, by the number of nodes; nothing is posed for those that cost
// more than evaluation in every chirp.
void NodeLevels::find_shapes() {
  if (settings_.exact) return;
  breakpoints_ = motion_breakpoints(*paths_.scene, radar_);
  knots_ = motion_knots(*paths_.scene, radar_);
  const double start = paths_.frame.start_time, end = start + radar_.frame_duration();
  for (std::vector<double>* cuts : {&breakpoints_, &knots_}) {
    std::erase_if(*cuts, [&](double time) { return time <= start || time >= end; });
  }
  const int64_t smooth = num_pieces(radar_, start, breakpoints_), analytic = num_pieces(radar_, start, knots_);
  for (const int order : kOrders) {
    shapes_.push_back({order, &breakpoints_, order * smooth, longest_piece(start, end, breakpoints_)});
    if (analytic > smooth) shapes_.push_back({order, &knots_, order * analytic, longest_piece(start, end, knots_)});
  }
  std::erase_if(shapes_, [&](const Shape& shape) { return shape.num_nodes > num_exact_nodes(); });
  std::stable_sort(shapes_.begin(), shapes_.end(), [](const Shape& a, const Shape& b) { return a.num_nodes < b.num_nodes; });
}

Instant NodeLevels::instant(double time) const {
  return Instant(*paths_.scene, radar_, localise_.patches(), paths_.frame.transmitter, time);
}

// Behind the polynomials come two levels for each transmitter.
FrameNodes NodeLevels::nodes_of(size_t index) const {
  const double start = paths_.frame.start_time;
  if (index == 0) return static_nodes(radar_, paths_.frame.trace_time);
  if (index >= centre_level(0)) return centre_nodes(radar_, start, static_cast<int>(index - centre_level(0)));
  if (index >= exact_level(0)) {
    return exact_nodes(radar_, start, exact_order(), static_cast<int>(index - exact_level(0)), derivatives());
  }
  const Shape& shape = shapes_[index - 1];
  return chebyshev_nodes(radar_, start, *shape.cuts, shape.order, derivatives());
}

std::vector<Instant> NodeLevels::instants_of(const FrameNodes& nodes, size_t index) const {
  std::vector<Instant> instants;
  if (index < tried_.size()) instants.swap(tried_[index].instants);
  if (!instants.empty()) return instants;
  for (const double time : nodes.times) {
    Instant& posed = instants.emplace_back(instant(time));
    if (index >= exact_level(0)) {
      posed.transmitters = {posed.transmitters[(index - exact_level(0)) % radar_.transmitters.size()]};
    }
  }
  return instants;
}

NodePoses NodeLevels::poses_of(const std::vector<Instant>& instants) const {
  return node_poses(instants, static_cast<uint32_t>(paths_.scene->meshes().size()));
}

const NodeLevel& NodeLevels::level(size_t index) const {
  const std::lock_guard lock(mutex_);
  std::unique_ptr<const NodeLevel>& slot = levels_[index];
  if (slot) return *slot;
  auto made = std::make_unique<NodeLevel>();
  made->nodes = nodes_of(index);
  made->instants = instants_of(made->nodes, index);
  made->poses = poses_of(made->instants);
  slot = std::move(made);
  return *slot;
}

NodeLevel NodeLevels::single(double time) const {
  NodeLevel level;
  level.instants.push_back(instant(time));
  level.poses = poses_of(level.instants);
  return level;
}

void NodeLevels::forget_chirps(int transmitter) const {
  const std::lock_guard lock(mutex_);
  for (const size_t index : {exact_level(transmitter), centre_level(transmitter)}) levels_[index].reset();
}

int NodeLevels::next_polynomial(int index, double needed_order) const {
  const std::vector<double>* cuts = shapes_[static_cast<size_t>(index - 1)].cuts;
  for (size_t next = static_cast<size_t>(index); next < shapes_.size(); ++next) {
    const Shape& shape = shapes_[next];
    if (shape.order >= needed_order || shape.cuts != cuts) return static_cast<int>(next) + 1;
  }
  return num_polynomials() + 1;
}

const NodeLevels::Trial& NodeLevels::trial_of(int polynomial) const {
  const auto index = static_cast<size_t>(polynomial);
  if (index >= tried_.size()) tried_.resize(index + 1);
  Trial& trial = tried_[index];
  if (!trial.instants.empty()) return trial;
  const Shape& shape = shapes_[index - 1];
  trial.nodes = unsampled_chebyshev_nodes(radar_, paths_.frame.start_time, *shape.cuts, shape.order);
  trial.instants = instants_of(trial.nodes, index);
  return trial;
}

// The Chebyshev coefficients of a turning by w over a piece of length T are Bessel functions of w T / 2, which fall but for orders
// above that: with fewer nodes it may look as if it stood still, as four of them find what turns four times.
bool NodeLevels::can_follow(int polynomial, double rate) const {
  const Shape& shape = shapes_[static_cast<size_t>(polynomial) - 1];
  return shape.order >= kNodesBeyondTurns + 0.5 * rate * shape.longest;
}

// The distances of vertices all over a mesh from the transmitters tell how many nodes its motion needs: an echo's length is
// made of such distances.
bool NodeLevels::fits(int polynomial, uint32_t mesh_id) const {
  const auto& [nodes, instants] = trial_of(polynomial);
  const Node& node = paths_.scene->node_of(mesh_id);
  const double wavenumber = radio_constants(paths_, radar_).wavenumber;
  const auto vertices_at = [&](const Instant& instant) -> const std::vector<Vec3>& {
    return node.deformation ? instant.deformed_vertices(mesh_id) : node.mesh->vertices();
  };
  const size_t num_vertices = vertices_at(instants.front()).size();
  const size_t step = std::max<size_t>(1, num_vertices / 16);
  std::vector<double> distance;
  for (size_t vertex = 0; vertex < num_vertices; vertex += step) {
    distance.clear();
    for (const Instant& instant : instants) {
      const Vec3 point = instant.rotation(mesh_id) * vertices_at(instant)[vertex] + instant.translation(mesh_id);
      distance.push_back(2.0 * (point - instant.transmitters.front().position).norm());
    }
    if (wavenumber * tail_of(nodes, distance) > settings_.phase_tolerance) return false;
  }
  return true;
}

// Sets them all or, where it throws, none: std::call_once then calls it again.
void NodeLevels::find_mesh_levels() const {
  const std::lock_guard lock(mutex_);
  std::vector<int> levels;
  const TimeSpan frame{paths_.frame.start_time, paths_.frame.start_time + radar_.frame_duration()};
  const double of_radar = turn_rate(radar_, frame);
  for (uint32_t id = 0; id < paths_.scene->meshes().size(); ++id) {
    const bool moves = paths_.scene->is_moving(id) || radar_.motion;
    int& needed = levels.emplace_back(moves ? 1 : 0);
    const double rate = moves ? turn_rate(*paths_.scene, id, frame) + of_radar : 0.0;
    while (moves && needed <= num_polynomials() && !(can_follow(needed, rate) && fits(needed, id))) ++needed;
  }
  mesh_level_ = std::move(levels);
}

const std::vector<int>& NodeLevels::mesh_levels() const {
  std::call_once(mesh_levels_made_, [&] { find_mesh_levels(); });
  return mesh_level_;
}

int NodeLevels::first_level(int64_t path) const {
  uint8_t level;
  first_levels(path, {&level, 1});
  return level;
}

void NodeLevels::first_levels(int64_t begin, std::span<uint8_t> levels) const {
  const int* const of_mesh = mesh_levels().data();
  const int least = radar_.motion ? 1 : 0;
  for (size_t i = 0; i < levels.size(); ++i) {
    const int64_t path = begin + static_cast<int64_t>(i);
    const Hit* hits = paths_.hits_of(path);
    const int num_hits = paths_.num_bounces[static_cast<size_t>(path)];
    int needed = least;
    // Most paths have one to four hits, and a branch on the number would be mispredicted: the last of them stands for those beyond.
    for (int k = 0; k < num_hits; k += 4) {
      for (int step = 0; step < 4; ++step) needed = std::max(needed, of_mesh[hits[std::min(k + step, num_hits - 1)].mesh_id]);
    }
    levels[i] = static_cast<uint8_t>(needed);
  }
}

}  // namespace echopath
