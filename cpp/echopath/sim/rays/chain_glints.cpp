#include "echopath/sim/rays/chain_glints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <utility>

#include "echopath/base/constants.h"
#include "echopath/base/principal_axes.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/replay/factors/launch_cell.h"
#include "echopath/replay/kernels/path_formula.h"
#include "echopath/replay/posed/local_paths.h"
#include "echopath/sim/rays/glint_routes.h"

namespace echopath {
namespace {

constexpr double kReach = 1.0;          // cells, along each axis of h: rays further away say little of the glint
constexpr double kOfStep = 0.25;        // of the way to the glint, by which it may lie elsewhere
constexpr double kMostTurn = 0.5;       // rad, of the normal across a cell: beyond, the surface is another one there
constexpr double kSameZone = 0.5;       // of the narrower Fresnel zone: directions so near to each other are one
constexpr double kAlike = 2.0;          // ratio of the powers of one glint as two cells tell it
constexpr int kWitnesses = 2;           // cells that point at a glint, of about four that reach it
constexpr size_t kMostOfStratum = 512;  // that are compared with each other, the strongest
constexpr double kTinyTurn = 1e-9;      // rad per cell^2

// Holds the phase across a launch cell along the axes of its second derivative.
struct CellPhase {
  Eigen::Vector2d slope, second_derivative;  // rad per cell, rad per cell^2
  Eigen::Matrix2d axes;                      // columns
};

CellPhase along_axes(const FootprintPhaseOf<double>& phase) {
  Eigen::Matrix2d h;
  h << phase.h11, phase.h12, phase.h12, phase.h22;
  const PrincipalAxes principal = principal_axes(h);
  return {principal.axes.transpose() * Eigen::Vector2d(phase.g1, phase.g2), principal.values, principal.axes};
}

class ChainGlintSearch {
 public:
  explicit ChainGlintSearch(const Paths& paths)
      : paths_(paths), preparer_(paths, touched_meshes(paths)),
        wavenumber_(kTwoPi * paths.radar.waveform.start_frequency / kSpeedOfLight) {}

  // Returns the glint that the cell of a path points at. `amplitude` is that of the path without a filter.
  std::optional<Glint> glint_of(int64_t path, double amplitude) const {
    std::deque<std::array<Vec3, 3>> normals;
    std::vector<PosedHit> hits = hits_as_traced(path, normals);
    const LaunchCell launched = recorded_cell(paths_.curved_cell[path]);
    const CellTangents tangents = cell_tangents(launched, hits.back());
    if (turns_too_much(hits.back(), tangents)) return std::nullopt;
    const CellPhase phase = along_axes(phase_at(hits, launched, tangents));
    const size_t stratum = paths_.stratum[path];
    const Stratum& of = paths_.frame.strata[stratum];
    const double cell = 1.0 / std::sqrt(paths_.frame.lattice_density(stratum));  // rad
    Eigen::Vector2d step;
    double zones[2];
    for (int axis = 0; axis < 2; ++axis) {
      const double second_derivative = std::abs(phase.second_derivative[axis]) + kTinyTurn;
      if (std::abs(phase.slope[axis]) > kReach * second_derivative) return std::nullopt;
      step[axis] = -phase.slope[axis] / std::copysign(second_derivative, phase.second_derivative[axis]);
      zones[axis] = cell * std::sqrt(kTwoPi / second_derivative);
    }
    const Eigen::Vector2d away = cell * (phase.axes * step);
    const Vec3 launch = (hits.front().is_smooth ? hits.front().facet : hits.front().point).normalized();
    const Vec3 right = launch.unitOrthogonal(), up = launch.cross(right);
    const double field = amplitude * zones[0] * zones[1] * of.ray_density;
    return Glint{of.is_focus() ? of.focus_of : static_cast<int>(stratum),
                 (launch + away[0] * right + away[1] * up).normalized(),
                 field * field,
                 std::min(zones[0], zones[1]),
                 std::max(zones[0], zones[1]),
                 true,
                 kOfStep * away.norm()};
  }

 private:
  // Returns the hits relative to the transmitter, from which the ray started.
  std::vector<PosedHit> hits_as_traced(int64_t path, std::deque<std::array<Vec3, 3>>& normals) const {
    std::vector<PosedHit> posed(paths_.num_bounces[path]);
    for (size_t k = 0; k < posed.size(); ++k)
      pose_hit(preparer_.hit(paths_.hits_of(path)[k], normals), preparer_.at_trace(), true, posed[k]);
    if (paths_.is_reversed(path)) std::ranges::reverse(posed);
    return posed;
  }

  static bool turns_too_much(const PosedHit& hit, const CellTangents& tangents) {
    return hit.is_smooth &&
           std::ranges::any_of(tangents, [&](const Vec3& tangent) { return (hit.curvature * tangent).norm() > kMostTurn; });
  }

  FootprintPhaseOf<double> phase_at(const std::vector<PosedHit>& hits, const LaunchCell& cell,
                                    const CellTangents& tangents) const {
    const PosedHit& last = hits.back();
    const Vec3 arrival = (last.point - hits[hits.size() - 2].point).normalized();
    const Vec3 way = paths_.frame.receiver - paths_.frame.transmitter - last.point;
    const double distance = way.norm();
    CellWaves<double> waves;
    set_waves<ScalarMath>(-arrival.dot(last.normal), way.dot(last.normal) / distance, 0.0, 1.0 / distance, waves);
    for (size_t a = 0; a < 2; ++a) {
      waves.along_arrival[a] = tangents[a].dot(arrival);
      waves.along_departure[a] = tangents[a].dot(way) / distance;
    }
    CellFilter filter;
    filter.wavenumber = wavenumber_;
    return cell_phase(cell_shape(cell, last, tangents), waves, filter);
  }

  const Paths& paths_;
  const PathPreparer preparer_;
  const double wavenumber_;
};

// Returns whether the path has been traced as a wave over curved surfaces to another, which radiates straight to the
// receiver.
bool is_chain(const Paths& paths, int64_t path) {
  if (!paths.is_coherent_with_cell(path) || paths.num_bounces[path] < 2 || !paths.curved_cell_of(path)) return false;
  const Hit& last = paths.hits_of(path)[paths.is_reversed(path) ? 0 : paths.num_bounces[path] - 1];
  return !paths.scene->node_of(last.mesh_id).material->mirror;
}

// Returns at most kMostOfStratum glints of each stratum, strongest first.
std::vector<Glint> strongest_of_each(std::vector<Glint> glints) {
  std::ranges::stable_sort(glints, std::greater(), &Glint::power);
  std::map<int, size_t> count;
  std::erase_if(glints, [&](const Glint& glint) { return ++count[glint.stratum] > kMostOfStratum; });
  return glints;
}

// Returns whether two cells point at one place, each as far as it can tell.
bool agree(const Glint& a, const Glint& b) {
  const double away = (a.direction - b.direction).norm();
  return a.stratum == b.stratum && away <= std::max(a.blur + b.blur, kSameZone * std::min(a.narrow, b.narrow)) &&
         a.power <= kAlike * b.power && b.power <= kAlike * a.power;
}

// Returns the glints at which several cells point. What one cell points at alone lies beyond the reach of its second order:
// the surface has turned on the way, or ends.
std::vector<Glint> agreed(const std::vector<Glint>& glints) {
  std::vector<Glint> kept;
  for (const Glint& glint : glints) {
    const auto count = std::ranges::count_if(glints, [&](const Glint& other) { return agree(glint, other); });
    if (count >= kWitnesses) kept.push_back(glint);
  }
  return kept;
}

}  // namespace

std::vector<Glint> find_chain_glints(const Paths& paths, Job* job) {
  std::vector<int64_t> chains;
  for (int64_t path = 0; path < paths.num_paths(); ++path) {
    if (is_chain(paths, path)) chains.push_back(path);
  }
  if (chains.empty()) return {};
  const std::vector<double> amplitudes = unfiltered_amplitudes(paths, chains, job);
  const ChainGlintSearch search(paths);
  std::vector<std::optional<Glint>> found(chains.size());
  constexpr int64_t kTogether = 1024;
  Job unseen(job);
  parallel_for_chunks(std::ssize(chains), kTogether, [&](int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; ++i) found[i] = search.glint_of(chains[i], amplitudes[i]);
  }, &unseen);
  std::vector<Glint> glints;
  for (const std::optional<Glint>& glint : found) {
    if (glint) glints.push_back(*glint);
  }
  return agreed(strongest_of_each(std::move(glints)));
}

}  // namespace echopath
