#include "echopath/scene/edges/edge_finder.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "echopath/base/constants.h"
#include "echopath/base/geometry.h"

namespace echopath {
namespace {

constexpr double kSamePlace = 1e-6;      // of the extent of the mesh: two lines as near to each other are one
constexpr double kSameDirection = 1e-6;  // rad, likewise for faces about one edge

// Describes a side of a triangle as a stretch of a line.
struct EdgeSide {
  uint32_t surface, triangle, side;
  Vec3 from, to;     // m
  Vec3 direction;    // unit, the same for all sides along one line
  Vec3 foot;         // m, of the line next to the middle of the mesh
  double low, high;  // m, of the stretch along the direction
  double key;        // sides on one line have nearly the same

  bool runs_along() const { return (to - from).dot(direction) > 0; }
};

// Returns the vector or its opposite, so that its largest component, the first of several nearly as large, is positive.
Vec3 one_way(const Vec3& v) {
  const double largest = v.cwiseAbs().maxCoeff();
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(v[axis]) > 0.999 * largest) return v[axis] < 0 ? Vec3(-v) : v;
  }
  return v;
}

class SharpEdgeFinder {
 public:
  explicit SharpEdgeFinder(std::span<const EdgeSurface> surfaces) : surfaces_(surfaces) {
    Box box;
    for (const EdgeSurface& surface : surfaces_) {
      for (const Vec3& vertex : surface.mesh->vertices()) box.extend(surface.place * vertex);
    }
    middle_ = box.center();
    tolerance_ = kSamePlace * box.diagonal().norm();
  }

  FoundEdges find() {
    list_sides();
    for (size_t first = 0; first < sides_.size(); ++first) {
      if (!is_taken_[first]) take_line(first);
    }
    const auto key = [](const FoundEdge& found) {
      return std::tie(found.surface, found.edge.triangle, found.edge.side, found.edge.begin);
    };
    std::ranges::sort(found_.edges, {}, key);
    return std::move(found_);
  }

 private:
  void list_sides() {
    for (uint32_t surface = 0; surface < surfaces_.size(); ++surface) {
      for (uint32_t t = 0; t < surfaces_[surface].mesh->triangles().size(); ++t) {
        for (uint32_t side = 0; side < 3; ++side) add_side(surface, t, side);
      }
    }
    std::ranges::sort(sides_, [](const EdgeSide& a, const EdgeSide& b) {
      return std::tie(a.key, a.surface, a.triangle, a.side) < std::tie(b.key, b.surface, b.triangle, b.side);
    });
    is_taken_.assign(sides_.size(), false);
  }

  Vec3 corner(uint32_t surface, uint32_t triangle, uint32_t index) const {
    const EdgeSurface& of = surfaces_[surface];
    return of.place * of.mesh->vertices()[of.mesh->triangles()[triangle][index]];
  }

  // Adds it where it may touch another surface.
  void add_side(uint32_t surface, uint32_t triangle, uint32_t side) {
    const Vec3 from = corner(surface, triangle, side), to = corner(surface, triangle, (side + 1) % 3);
    if (!surfaces_[surface].may_touch(from, to)) return;
    const Vec3 direction = one_way((to - from).normalized());
    const Vec3 foot = from - middle_ - direction.dot(from - middle_) * direction;
    const double a = direction.dot(from - middle_), b = direction.dot(to - middle_);
    const double key = foot.dot(kSortingDirection);
    sides_.push_back({surface, triangle, side, from, to, direction, foot, std::min(a, b), std::max(a, b), key});
  }

  // Takes all sides along the line of one side, and looks at each stretch between their ends.
  void take_line(size_t first) {
    std::vector<size_t> line;
    const EdgeSide& one = sides_[first];
    const double reach = one.high - one.low;
    for (size_t i = first; i < sides_.size() && sides_[i].key <= one.key + 2.0 * tolerance_; ++i) {
      const EdgeSide& other = sides_[i];
      const double turn = std::max(reach, other.high - other.low) * other.direction.cross(one.direction).norm();
      if (is_taken_[i] || turn > tolerance_ || (other.foot - one.foot).norm() > 2.0 * tolerance_) continue;
      is_taken_[i] = true;
      line.push_back(i);
    }
    std::ranges::sort(line, {}, [&](size_t side) { return sides_[side].low; });
    for (size_t begin = 0, end = 0; begin < line.size(); begin = end) {
      double reached = sides_[line[begin]].high;
      while (end < line.size() && sides_[line[end]].low < reached - tolerance_)
        reached = std::max(reached, sides_[line[end++]].high);
      take_run({line.data() + begin, end - begin});
    }
  }

  // Takes sides that overlap.
  void take_run(std::span<const size_t> run) {
    std::vector<double> ends;
    for (const size_t side : run) {
      ends.push_back(sides_[side].low);
      ends.push_back(sides_[side].high);
    }
    std::ranges::sort(ends);
    for (size_t i = 0; i + 1 < ends.size(); ++i) {
      if (ends[i + 1] - ends[i] <= 2.0 * tolerance_) continue;
      std::vector<size_t> here;
      const double middle = 0.5 * (ends[i] + ends[i + 1]);
      for (const size_t side : run) {
        if (sides_[side].low < middle && sides_[side].high > middle) here.push_back(side);
      }
      if (!here.empty()) take_stretch(here, ends[i], ends[i + 1]);
    }
  }

  // Describes a face about an edge.
  struct Face {
    double angle;  // rad, about the edge
    Vec3 inward;
  };

  Vec3 inward_of(const EdgeSide& side) const {
    const Vec3 opposite = corner(side.surface, side.triangle, (side.side + 2) % 3);
    const Vec3 along = (side.to - side.from).normalized(), line = opposite - side.from;
    return (line - along.dot(line) * along).normalized();
  }

  // Returns the faces in the order of their angles about the edge; faces that lie on each other are one.
  std::vector<Face> faces_about(const std::vector<size_t>& here) const {
    const Vec3 axis = sides_[here.front()].direction, first = inward_of(sides_[here.front()]), second = axis.cross(first);
    std::vector<Face> faces;
    for (const size_t side : here) {
      const Vec3 inward = inward_of(sides_[side]);
      double angle = std::atan2(inward.dot(second), inward.dot(first));
      if (angle < -kSameDirection) angle += kTwoPi;
      const auto is_same = [&](const Face& face) { return std::abs(face.angle - angle) <= kSameDirection; };
      if (std::ranges::none_of(faces, is_same)) faces.push_back({angle, inward});
    }
    std::ranges::sort(faces, {}, &Face::angle);
    return faces;
  }

  void take_stretch(const std::vector<size_t>& here, double low, double high) {
    const auto is_elsewhere = [&](size_t i) { return sides_[i].surface != sides_[here.front()].surface; };
    const bool is_shared = std::ranges::any_of(here, is_elsewhere);
    if (surfaces_.size() > 1 && !is_shared) return;
    if (is_shared) add_seam(here, low, high);
    const std::vector<Face> faces = faces_about(here);
    const Vec3 axis = sides_[here.front()].direction;
    for (size_t i = 0; i < faces.size(); ++i) {
      const bool is_last = i + 1 == faces.size();
      const Face &face = faces[i], &next = faces[is_last ? 0 : i + 1];
      const double space = next.angle + (is_last ? kTwoPi : 0.0) - face.angle;
      if (space < kPi + kSharpTurn) continue;
      add_edge(here, low, high, {face.inward, next.inward}, {axis.cross(face.inward), -axis.cross(next.inward)});
      return;
    }
  }

  // Returns the order in which sides have an edge.
  auto by_owner() const {
    return [this](size_t a, size_t b) {
      return std::tie(sides_[a].surface, sides_[a].triangle) < std::tie(sides_[b].surface, sides_[b].triangle);
    };
  }

  static std::pair<double, double> stretch_of(const EdgeSide& side, double low, double high) {
    const double length = side.high - side.low;
    const double begin = std::clamp((low - side.low) / length, 0.0, 1.0),
                 end = std::clamp((high - side.low) / length, 0.0, 1.0);
    return side.runs_along() ? std::pair(begin, end) : std::pair(1.0 - end, 1.0 - begin);
  }

  void add_seam(const std::vector<size_t>& here, double low, double high) {
    Seam& seam = found_.seams.emplace_back();
    for (const size_t i : here) {
      const EdgeSide& side = sides_[i];
      const auto [begin, end] = stretch_of(side, low, high);
      seam.push_back({side.surface, side.triangle, side.side, begin, end});
    }
  }

  void add_edge(const std::vector<size_t>& here, double low, double high, const std::array<Vec3, 2>& inward,
                const std::array<Vec3, 2>& normal) {
    const EdgeSide& side = sides_[*std::ranges::min_element(here, by_owner())];
    const auto [begin, end] = stretch_of(side, low, high);
    found_.edges.push_back(
        {side.surface, {side.triangle, side.side, begin, end, {inward[0], inward[1]}, {normal[0], normal[1]}}});
  }

  std::span<const EdgeSurface> surfaces_;
  Vec3 middle_;
  double tolerance_;  // m
  std::vector<EdgeSide> sides_;
  std::vector<bool> is_taken_;
  FoundEdges found_;
};

}  // namespace

FoundEdges find_edges(std::span<const EdgeSurface> surfaces) { return SharpEdgeFinder(surfaces).find(); }

}  // namespace echopath
