#include "echopath/replay/time/path_grids.h"

#include <algorithm>
#include <limits>

#include "echopath/replay/meshes_of_path.h"
#include "echopath/replay/time/chebyshev_tails.h"
#include "echopath/replay/time/turn_rates.h"
#include "echopath/scene/runs/nearest_of_runs.h"

namespace echopath {
namespace {

constexpr int kNodesBeyondTurns = 2;  // nodes beyond w T / 2 from which on coefficients fall (is_quick_enough)
// Evaluating amplitudes in this many chirps costs as much as one more node, counting polynomials that are tried in vain.
constexpr int64_t kWorthOfANode = 5;
constexpr size_t kTriedVertices = 16;  // of a mesh, at least, where it has as many
// Way across a beam from one node to the next, over the angle at which its field has fallen to exp(-1/2) of its peak: at a
// node the field is at least that then, wherever it passes.
constexpr double kStepInBeam = 2.0;
// Sharpness (AntennaPattern) from which on what lies beside a beam may be dark at all nodes: some 35 degrees at half the
// power. Wider ones are seen from everywhere ahead.
constexpr double kNarrow = 4.0;

// Holds vertices all over a mesh in its frame, m, at the nodes of a grid. They do not depend on which triangles paths touch,
// as patches do.
class TriedVertices {
 public:
  TriedVertices(const Node& node, const PosedScenes& scenes) {
    const std::vector<Vec3>& at_rest = node.mesh->vertices();
    const size_t step = std::max<size_t>(1, at_rest.size() / kTriedVertices);
    std::vector<uint32_t> original;
    at_.emplace_back();
    for (size_t vertex = 0; vertex < at_rest.size(); vertex += step) {
      at_[0].push_back(at_rest[vertex]);
      original.push_back(node.mesh->original_vertex()[vertex]);
    }
    if (!node.deformation) return;
    at_.resize(scenes.size());
    for (size_t k = 0; k < scenes.size(); ++k) node.deformation->at(scenes[k].time(), original, at_[k]);
  }

  size_t size() const { return at_[0].size(); }
  const Vec3& at(size_t node, size_t vertex) const { return at_[at_.size() > 1 ? node : 0][vertex]; }

 private:
  std::vector<std::vector<Vec3>> at_;  // by node where the mesh deforms, else one for all
};

// Returns the sharpness (AntennaPattern) of the two-way beam, which is sharper than that of either end.
double sharpness_of(const Radar& radar) {
  double largest[2] = {0.0, 0.0};
  const std::vector<Antenna>* const ends[] = {&radar.transmitters, &radar.receivers};
  for (int end = 0; end < 2; ++end) {
    for (const Antenna& antenna : *ends[end]) largest[end] = std::max(largest[end], antenna.pattern.sharpness());
  }
  return std::hypot(largest[0], largest[1]);
}

// Returns whether a point, seen by the antenna of a posed scene, passes no beam between two nodes of a piece.
// position(node) is the point relative to the origin of that scene, m.
template <class Position>
bool stays_in_beam(const FrameNodes& nodes, const PosedScenes& scenes, bool of_receivers, double sharpness,
                   const Position& position) {
  Vec3 before = Vec3::Zero();  // the direction in the axes of the antenna
  for (size_t node = 0; node < scenes.size(); ++node) {
    const PosedAntenna& antenna = scenes[node].antennas(of_receivers).front();
    const Vec3 direction = antenna.antenna_from_world * (position(node) - antenna.position).normalized();
    const bool is_first_of_piece = node % static_cast<size_t>(nodes.order) == 0;
    if (!is_first_of_piece && sharpness * (direction - before).norm() > kStepInBeam) return false;
    before = direction;
  }
  return true;
}

// Returns the point of a mesh, in its frame, that is nearest to `from`. It sweeps through a beam the fastest.
Vec3 nearest_of_mesh(const Mesh& mesh, const Vec3& from) {
  const std::vector<Vec3>& vertices = mesh.vertices();
  const auto corners_of = [&](uint32_t triangle) -> std::array<Vec3, 3> {
    const Triangle& corners = mesh.triangles()[triangle];
    return {vertices[corners[0]], vertices[corners[1]], vertices[corners[2]]};
  };
  const NearestOfRuns runs(mesh.boxes_of_runs(), mesh.triangles().size());
  return runs.within(std::numeric_limits<double>::infinity(), from, corners_of).value_or(mesh.vertices().front());
}

}  // namespace

// Holds the first and the last grid, in their order, of those that the meshes of a path need.
struct PathGrids::Range {
  GridIndex least, most;
  bool has_one_set_of_cuts() const { return least.cuts() == most.cuts(); }
};

PathGrids::PathGrids(const Paths& paths, const Radar& radar, TimeGrids& grids, PosedGrids& posed, double wavenumber,
                     double phase_tolerance)
    : paths_(paths), grids_(grids), wavenumber_(wavenumber), phase_tolerance_(phase_tolerance),
      sharpness_(sharpness_of(radar)), num_chirps_(radar.waveform.num_chirps), radar_moves_(radar.is_moving()) {
  const TimeSpan frame{grids.start_time(), grids.start_time() + radar.frame_duration()};
  const double of_radar = turn_rate(radar, frame);
  for (uint32_t id = 0; id < paths.scene->meshes().size(); ++id) {
    const bool moves = paths.scene->is_moving(id) || radar_moves_;
    of_mesh_.push_back(moves ? first_of_mesh(id, turn_rate(*paths.scene, id, frame) + of_radar, posed) : GridIndex::still());
  }
  are_cuts_of_radar_ = std::ranges::all_of(of_mesh_, [](GridIndex grid) { return grid.cuts() == MotionCuts::kOfRadar; });
  join_cuts(grids);
}

void PathGrids::join_cuts(TimeGrids& grids) const {
  const auto has_cuts_of_its_own = [](GridIndex grid) { return grid.cuts() != MotionCuts::kOfRadar; };
  const auto first = std::ranges::find_if(of_mesh_, has_cuts_of_its_own);
  const auto differs = [&](GridIndex grid) { return has_cuts_of_its_own(grid) && grid.cuts() != first->cuts(); };
  if (std::none_of(first, of_mesh_.end(), differs)) return;  // the cuts of all paths are those of a mesh
  for (int64_t path = 0; path < paths_.num_paths(); ++path) {
    if (range_of(path).has_one_set_of_cuts()) continue;
    uint32_t cuts = MotionCuts::kOfRadar;
    visit_meshes(paths_, path, [&](uint32_t mesh) { cuts = grids.join(cuts, of_mesh_[mesh].cuts()); });
  }
}

GridIndex PathGrids::first_of_mesh(uint32_t mesh_id, double turn_rate, PosedGrids& posed) const {
  const uint32_t cuts = grids_.cuts().of_mesh(mesh_id);
  for (size_t number = 0; number < grids_.num_polynomials(cuts); ++number) {
    const GridIndex polynomial = GridIndex::polynomial(number, cuts);
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
// nodes its motion needs. Where it passes a beam, or a beam sweeps over it, nodes are to see it there: with few of them it
// may be dark at all.
bool PathGrids::follows(const PosedGrid& trial, uint32_t mesh_id) const {
  const PosedScenes& scenes = *trial.posed.scenes;
  const TriedVertices vertices(paths_.scene->node_of(mesh_id), scenes);
  const bool is_narrow = sharpness_ > kNarrow;
  std::vector<double> distance;
  for (size_t vertex = 0; vertex < vertices.size(); ++vertex) {
    const auto position = [&](size_t node) -> Vec3 {
      return scenes[node].linear(mesh_id) * vertices.at(node, vertex) + scenes[node].translation(mesh_id);
    };
    distance.clear();
    for (size_t node = 0; node < scenes.size(); ++node)
      distance.push_back(2.0 * (position(node) - scenes[node].transmitters.front().position).norm());
    if (wavenumber_ * tail_of(trial.nodes, distance) > phase_tolerance_) return false;
    if (!is_narrow) continue;
    for (const bool of_receivers : {false, true}) {
      if (!stays_in_beam(trial.nodes, scenes, of_receivers, sharpness_, position)) return false;
    }
  }
  return !is_narrow || stays_in_beam_where_nearest(trial, mesh_id);
}

// Large triangles have places far from their corners: a floor of two beneath a radar, the wall that it drives along.
bool PathGrids::stays_in_beam_where_nearest(const PosedGrid& trial, uint32_t mesh_id) const {
  const PosedScenes& scenes = *trial.posed.scenes;
  const Node& node_of_mesh = paths_.scene->node_of(mesh_id);
  if (node_of_mesh.deformation) return true;  // the corners of what deforms lie close together
  for (const bool of_receivers : {false, true}) {
    for (const size_t nearest_at : {size_t{0}, scenes.size() / 2, scenes.size() - 1}) {
      const PosedScene& scene = scenes[nearest_at];
      const Vec3 way = scene.antennas(of_receivers).front().position - scene.translation(mesh_id);
      const Vec3 nearest = nearest_of_mesh(*node_of_mesh.mesh, scene.linear(mesh_id).inverse() * way);
      const auto position = [&](size_t node) -> Vec3 {
        return scenes[node].linear(mesh_id) * nearest + scenes[node].translation(mesh_id);
      };
      if (!stays_in_beam(trial.nodes, scenes, of_receivers, sharpness_, position)) return false;
    }
  }
  return true;
}

GridIndex PathGrids::first(int64_t path) const {
  GridIndex first = radar_moves_ ? GridIndex::polynomial(0) : GridIndex::still();
  if (are_cuts_of_radar_) {
    visit_grids(path, [&](GridIndex grid) { first = std::max(first, grid); });
    return first;
  }
  const Range range = range_of(path);
  return std::max(first, range.has_one_set_of_cuts() ? range.most : first_in_joined_cuts(path));
}

PathGrids::Range PathGrids::range_of(int64_t path) const {
  const GridIndex of_first = of_mesh_[paths_.hits_of(path)->mesh_id];
  Range range{of_first, of_first};
  visit_grids(path, [&](GridIndex grid) { range = {std::min(range.least, grid), std::max(range.most, grid)}; });
  return range;
}

// Calls add for the grid of each mesh that the path meets, of some more than once.
template <class Add>
void PathGrids::visit_grids(int64_t path, const Add& add) const {
  const GridIndex* const of_mesh = of_mesh_.data();
  const Hit* const hits = paths_.hits_of(path);
  const int num_hits = paths_.num_bounces[path];
  // Most paths have one to four hits, and a branch on the number would be mispredicted: so the last hit is read again in
  // place of those that are missing.
  for (int k = 0; k < num_hits; k += 4) {
    for (int step = 0; step < 4; ++step) add(of_mesh[hits[std::min(k + step, num_hits - 1)].mesh_id]);
  }
  if (!paths_.passes.empty()) {
    for (const Pass& pass : paths_.passes_of(path)) add(of_mesh[pass.hit.mesh_id]);
  }
}

// Finds the grid of a path over meshes with several sets of cuts.
GridIndex PathGrids::first_in_joined_cuts(int64_t path) const {
  uint32_t cuts = MotionCuts::kOfRadar;
  visit_meshes(paths_, path, [&](uint32_t mesh) { cuts = grids_.cuts().joined(cuts, of_mesh_[mesh].cuts()); });
  GridIndex needed;
  bool is_followed = true;
  visit_meshes(paths_, path, [&](uint32_t mesh) {
    const GridIndex grid = grids_.in_cuts(of_mesh_[mesh], cuts);
    is_followed = is_followed && grid != GridIndex::none();
    needed = std::max(needed, grid);
  });
  return is_followed ? needed : GridIndex::none();
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
