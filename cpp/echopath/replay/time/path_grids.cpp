#include "echopath/replay/time/path_grids.h"

#include <algorithm>

#include "echopath/replay/time/node_tails.h"
#include "echopath/replay/time/turn_rates.h"

namespace echopath {
namespace {

constexpr int kNodesBeyondTurns = 2;  // nodes beyond w T / 2 from which on coefficients fall (is_quick_enough)
// Evaluating amplitudes in this many chirps costs as much as one more node, counting polynomials that are tried in vain.
constexpr int64_t kWorthOfANode = 5;

}  // namespace

PathGrids::PathGrids(const Paths& paths, const Radar& radar, const TimeGrids& grids, PosedGrids& posed, double wavenumber,
                     double phase_tolerance)
    : paths_(paths), grids_(grids), wavenumber_(wavenumber), phase_tolerance_(phase_tolerance),
      num_chirps_(radar.waveform.num_chirps), radar_moves_(radar.motion != nullptr) {
  const TimeSpan frame{grids.start_time(), grids.start_time() + radar.frame_duration()};
  const double of_radar = turn_rate(radar, frame);
  for (uint32_t id = 0; id < paths.scene->meshes().size(); ++id) {
    const bool moves = paths.scene->is_moving(id) || radar.motion;
    of_mesh_.push_back(moves ? first_of_mesh(id, turn_rate(*paths.scene, id, frame) + of_radar, posed) : GridIndex::still());
  }
}

GridIndex PathGrids::first_of_mesh(uint32_t mesh_id, double turn_rate, PosedGrids& posed) const {
  for (size_t number = 0; number < grids_.num_polynomials(); ++number) {
    const GridIndex polynomial = GridIndex::polynomial(number);
    if (is_quick_enough(polynomial, turn_rate) && follows(posed.trial(polynomial), mesh_id)) return polynomial;
  }
  return GridIndex::none();
}

// The Chebyshev coefficients of a rotation at w over a piece of length T are Bessel functions of w T / 2, which fall only
// for orders above that. With fewer nodes the mesh may seem to stand still, as when four nodes see a mesh that turns four
// times.
bool PathGrids::is_quick_enough(GridIndex polynomial, double turn_rate) const {
  const PolynomialGrid& grid = grids_.polynomial(polynomial);
  return grid.order >= kNodesBeyondTurns + 0.5 * turn_rate * grid.longest_piece;
}

// The length of a path is made of distances, so those of vertices all over a mesh from the first transmitter tell how many
// nodes its motion needs.
bool PathGrids::follows(const TrialGrid& trial, uint32_t mesh_id) const {
  const auto& [nodes, scenes] = trial;
  const size_t num_vertices = scenes->front().local_vertices(mesh_id).size();
  const size_t step = std::max<size_t>(1, num_vertices / 16);
  std::vector<double> distance;
  for (size_t vertex = 0; vertex < num_vertices; vertex += step) {
    distance.clear();
    for (const PosedScene& scene : *scenes) {
      const Vec3 point = scene.linear(mesh_id) * scene.local_vertices(mesh_id)[vertex] + scene.translation(mesh_id);
      distance.push_back(2.0 * (point - scene.transmitters.front().position).norm());
    }
    if (wavenumber_ * tail_of(nodes, distance) > phase_tolerance_) return false;
  }
  return true;
}

GridIndex PathGrids::first(int64_t path) const {
  GridIndex grid;
  first(path, {&grid, 1});
  return grid;
}

void PathGrids::first(int64_t begin, std::span<GridIndex> first) const {
  const GridIndex* const of_mesh = of_mesh_.data();
  const GridIndex least = radar_moves_ ? GridIndex::polynomial(0) : GridIndex::still();
  for (size_t i = 0; i < first.size(); ++i) {
    const int64_t path = begin + static_cast<int64_t>(i);
    const Hit* hits = paths_.hits_of(path);
    const int num_hits = paths_.num_bounces[static_cast<size_t>(path)];
    GridIndex needed = least;
    // Most paths have one to four hits, and a branch on the number would be mispredicted: so the last hit is read again in
    // place of those that are missing.
    for (int k = 0; k < num_hits; k += 4) {
      for (int step = 0; step < 4; ++step)
        needed = std::max(needed, of_mesh[hits[std::min(k + step, num_hits - 1)].mesh_id]);
    }
    if (!paths_.passes.empty()) {
      for (const Pass& pass : paths_.passes_of(static_cast<size_t>(path)))
        needed = std::max(needed, of_mesh[pass.hit.mesh_id]);
    }
    first[i] = needed;
  }
}

// Amplitudes that a polynomial follows late or never are evaluated in every chirp: those of surfaces that turn their other
// side, and those that a polynomial of the order that their own tail called for did not follow.
NextGrid PathGrids::next(const UnfollowedPath& path, GridIndex polynomial) const {
  const double needed_order = std::max(path.order_for_length, path.is_turned ? 0.0 : path.order_for_amplitude);
  const GridIndex next = grids_.next_polynomial(polynomial, needed_order);
  const bool was_tried_before = first(path.path) < polynomial;
  const bool is_costly = next == GridIndex::none() || grids_.polynomial(next).num_nodes * kWorthOfANode >= num_chirps_;
  const bool is_late = path.is_turned || was_tried_before || is_costly;
  if (path.order_for_length == 0.0 && is_late) return {polynomial, true};
  return {next, false};
}

}  // namespace echopath
