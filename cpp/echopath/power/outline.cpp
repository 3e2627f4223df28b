#include "echopath/power/outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "echopath/base/constants.h"
#include "echopath/base/parallel.h"
#include "echopath/posed/posed_scene.h"
#include "echopath/scene/mesh/smooth.h"

namespace echopath {
namespace {

constexpr double kAround =
    1.35;  // cells: the six neighbours in a lattice are .95 to 1.16 away (trace/launch/launch_lattice.h)
constexpr double kSameCell = 0.1;                   // cells: of one ray
constexpr double kWidestGap = 100.0 * kPi / 180.0;  // rad, between neighbours: 66 degrees in a lattice, over 130 at its rim
constexpr double kStep = 0.3;    // of the way between two hits, out of the surface, for both normals together
constexpr double kPlane = 1e-4;  // likewise, of hits on flat facets

// A surface at a hit.
struct Place {
  Vec3 position, normal;
  Vec3 facet;  // the point on the flat triangle, which the ray met
  bool is_smooth = false;
};

bool goes_on(const Place& a, const Place& b) {
  const Vec3 way = b.position - a.position;
  const double length = way.norm();
  if (a.is_smooth && b.is_smooth)
    return std::abs((a.normal + b.normal).dot(way)) <= kStep * length && a.normal.dot(b.normal) > 0.0;
  return a.normal.dot(b.normal) >= 1.0 - kPlane * kPlane && std::abs(a.normal.dot(way)) <= kPlane * length;
}

// The smooth normals of meshes that are met.
class Surfaces {
 public:
  Surfaces(const Paths& paths, std::span<const int64_t> members)
      : scene_(*paths.scene), pose_(scene_, paths.frame.trace_time), normals_(scene_.meshes().size()) {
    std::vector<uint8_t> is_met(normals_.size(), 0);
    for (const int64_t path : members) {
      for (int k = 0; k < paths.num_bounces[static_cast<size_t>(path)]; ++k) is_met[paths.hits_of(path)[k].mesh_id] = 1;
    }
    parallel_for(std::ssize(is_met), [&](int64_t i) {
      const auto mesh = static_cast<uint32_t>(i);
      if (is_met[mesh] && scene_.node_of(mesh).smooth) normals_[mesh] = pose_.world_normals(mesh);
    });
  }

  Place at(const Hit& hit) const {
    const std::array<Vec3, 3> corners = pose_.world_triangle(hit.mesh_id, hit.triangle_id);
    const auto& [a, b, c] = corners;
    const Vec3 facet_normal = (b - a).cross(c - a).normalized();
    const double u = hit.u, v = hit.v;
    const Vec3 facet = a + u * (b - a) + v * (c - a);
    if (!normals_[hit.mesh_id].empty()) {
      const Triangle& triangle = scene_.node_of(hit.mesh_id).mesh->triangles()[hit.triangle_id];
      const std::vector<Vec3>& of_mesh = normals_[hit.mesh_id];
      const std::array<Vec3, 3> normals = {of_mesh[triangle[0]], of_mesh[triangle[1]], of_mesh[triangle[2]]};
      if (is_smooth_facet(facet_normal, normals)) {
        const SmoothPoint point = smooth_point(corners, normals, u, v);
        return {point.position, point.normal, facet, true};
      }
    }
    return {facet, facet_normal, facet, false};
  }

 private:
  const Scene& scene_;
  const PosedScene pose_;
  std::vector<std::vector<Vec3>> normals_;  // by mesh; empty: not smooth, or not met
};

// A member as its ray sees it.
struct Cell {
  Vec3 direction;      // of launch
  size_t first_place;  // in Cells::places_
};

// Orders members so that those that may surround each other stand together.
class Kinship {
 public:
  explicit Kinship(const Paths& paths) : paths_(paths) {}
  int compare(int64_t a, int64_t b) const {
    const auto p = static_cast<size_t>(a), q = static_cast<size_t>(b);
    const std::array<uint32_t, 4> first = {paths_.stratum[p], paths_.batch[p], paths_.num_bounces[p],
                                           paths_.flags[p] & kReversedPath};
    const std::array<uint32_t, 4> second = {paths_.stratum[q], paths_.batch[q], paths_.num_bounces[q],
                                            paths_.flags[q] & kReversedPath};
    if (first != second) return first < second ? -1 : 1;
    for (int k = 0; k < paths_.num_bounces[p]; ++k) {
      const uint32_t x = paths_.hits_of(a)[k].mesh_id, y = paths_.hits_of(b)[k].mesh_id;
      if (x != y) return x < y ? -1 : 1;
    }
    return 0;
  }

 private:
  const Paths& paths_;
};

class Cells {
 public:
  Cells(const Paths& paths, std::span<const int64_t> members, std::span<const uint32_t> sets)
      : paths_(paths), members_(members), sets_(sets) {
    cells_.resize(members.size());
    size_t num_places = 0;
    for (size_t i = 0; i < members.size(); ++i) {
      cells_[i].first_place = num_places;
      num_places += paths.num_bounces[static_cast<size_t>(members[i])];
    }
    places_.resize(num_places);
    const Surfaces surfaces(paths, members);
    constexpr int64_t kTogether = 4096;
    parallel_for((std::ssize(members) + kTogether - 1) / kTogether, [&](int64_t task) {
      const auto begin = static_cast<size_t>(task * kTogether);
      for (size_t i = begin; i < std::min(begin + kTogether, members_.size()); ++i) place(i, surfaces);
    });
  }

  std::vector<uint8_t> at_rim() const {
    std::vector<uint8_t> found(members_.size(), 0);
    std::vector<size_t> order(members_.size());
    std::iota(order.begin(), order.end(), size_t{0});
    const Kinship kinship(paths_);
    const auto compare = [&](size_t a, size_t b) {
      if (!sets_.empty() && sets_[a] != sets_[b]) return sets_[a] < sets_[b] ? -1 : 1;
      return kinship.compare(members_[a], members_[b]);
    };
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return compare(a, b) < 0; });
    std::vector<std::span<size_t>> kin;
    for (size_t begin = 0, end = 0; begin < order.size(); begin = end) {
      while (end < order.size() && compare(order[begin], order[end]) == 0) ++end;
      kin.push_back(std::span(order).subspan(begin, end - begin));
    }
    parallel_for(std::ssize(kin), [&](int64_t i) { judge(kin[static_cast<size_t>(i)], found); });
    return found;
  }

 private:
  void place(size_t i, const Surfaces& surfaces) {
    const auto p = static_cast<size_t>(members_[i]);
    const Hit* hits = paths_.hits_of(members_[i]);
    const int count = paths_.num_bounces[p];
    for (int k = 0; k < count; ++k) places_[cells_[i].first_place + static_cast<size_t>(k)] = surfaces.at(hits[k]);
    const bool is_reversed = (paths_.flags[p] & kReversedPath) != 0;
    const Vec3& start = is_reversed ? paths_.frame.receiver : paths_.frame.transmitter;
    cells_[i].direction =
        (places_[cells_[i].first_place + static_cast<size_t>(is_reversed ? count - 1 : 0)].facet - start).normalized();
  }

  // Of cells that may surround each other: in rows along the axis of the longest extent, as high as a cell reaches.
  void judge(std::span<size_t> kin, std::vector<uint8_t>& found) const {
    const size_t stratum = paths_.stratum[static_cast<size_t>(members_[kin.front()])];
    const double cell = 1.0 / std::sqrt(paths_.frame.lattice_density(stratum)), reach = kAround * cell;
    const auto [along, across] = longest_axes(kin);
    const auto place_of = [&, along = along, across = across](size_t i) {
      const Vec3& direction = cells_[i].direction;
      return std::pair(std::floor(direction[across] / reach), direction[along]);
    };
    const auto stands_before = [&](size_t i, const std::pair<double, double>& place) { return place_of(i) < place; };
    std::stable_sort(kin.begin(), kin.end(), [&](size_t a, size_t b) { return place_of(a) < place_of(b); });
    constexpr int64_t kTogether = 1024;
    parallel_for((std::ssize(kin) + kTogether - 1) / kTogether, [&](int64_t task) {
      const auto first = static_cast<size_t>(task * kTogether);
      std::vector<size_t> others;
      for (size_t at = first; at < std::min(first + kTogether, kin.size()); ++at) {
        const auto [row, here] = place_of(kin[at]);
        others.clear();
        for (const double beside : {row - 1.0, row, row + 1.0}) {
          const auto end = std::lower_bound(kin.begin(), kin.end(), std::pair(beside, here + reach), stands_before);
          others.insert(others.end(), std::lower_bound(kin.begin(), end, std::pair(beside, here - reach), stands_before),
                        end);
        }
        found[kin[at]] = !is_surrounded(kin[at], others, cell);
      }
    });
  }

  // The two axes along which the directions reach furthest.
  std::array<int, 2> longest_axes(std::span<const size_t> kin) const {
    Vec3 low = cells_[kin.front()].direction, high = low;
    for (const size_t i : kin) {
      low = low.cwiseMin(cells_[i].direction);
      high = high.cwiseMax(cells_[i].direction);
    }
    std::array<int, 3> axes = {0, 1, 2};
    std::stable_sort(axes.begin(), axes.end(), [&](int a, int b) { return high[a] - low[a] > high[b] - low[b]; });
    return {axes[0], axes[1]};
  }

  bool is_surrounded(size_t i, std::span<const size_t> others, double cell) const {
    constexpr size_t kMost = 32;
    const Vec3& middle = cells_[i].direction;
    const Vec3 right = middle.unitOrthogonal(), up = middle.cross(right);
    std::array<double, kMost> angles;
    size_t count = 0;
    for (const size_t other : others) {
      const Vec3 away = cells_[other].direction - middle;
      const double distance = away.squaredNorm();
      if (distance > kAround * kAround * cell * cell || distance < kSameCell * kSameCell * cell * cell) continue;
      if (count < kMost && is_same_surface(i, other)) angles[count++] = std::atan2(up.dot(away), right.dot(away));
    }
    if (count < 3) return false;
    std::sort(angles.begin(), angles.begin() + static_cast<std::ptrdiff_t>(count));
    double gap = angles[0] + kTwoPi - angles[count - 1];
    for (size_t k = 1; k < count; ++k) gap = std::max(gap, angles[k] - angles[k - 1]);
    return gap <= kWidestGap;
  }

  bool is_same_surface(size_t i, size_t other) const {
    const int count = paths_.num_bounces[static_cast<size_t>(members_[i])];
    for (size_t k = 0; k < static_cast<size_t>(count); ++k) {
      if (!goes_on(places_[cells_[i].first_place + k], places_[cells_[other].first_place + k])) return false;
    }
    return true;
  }

  const Paths& paths_;
  const std::span<const int64_t> members_;
  const std::span<const uint32_t> sets_;
  std::vector<Cell> cells_;
  std::vector<Place> places_;
};

}  // namespace

std::vector<uint8_t> cells_at_rim(const Paths& paths, std::span<const int64_t> members, std::span<const uint32_t> sets) {
  if (members.empty()) return {};
  return Cells(paths, members, sets).at_rim();
}

}  // namespace echopath
