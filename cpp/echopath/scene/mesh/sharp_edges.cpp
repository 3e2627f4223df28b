#include "echopath/scene/mesh/sharp_edges.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "echopath/base/constants.h"

namespace echopath {
namespace {

constexpr double kSamePlace = 1e-6;      // of the extent of the mesh: two lines as near to each other are one
constexpr double kSameDirection = 1e-6;  // rad, likewise for faces about one edge

// A side of a triangle as a stretch of a line.
struct EdgeSide {
  uint32_t triangle, side;
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
  explicit SharpEdgeFinder(const Mesh& surface) : mesh_(surface) {
    Eigen::AlignedBox3d box;
    for (const Vec3& vertex : mesh_.vertices()) box.extend(vertex);
    middle_ = box.center();
    tolerance_ = kSamePlace * box.diagonal().norm();
  }

  std::vector<SharpEdge> find() {
    list_sides();
    for (size_t first = 0; first < sides_.size(); ++first) {
      if (!is_taken_[first]) take_line(first);
    }
    const auto key = [](const SharpEdge& edge) { return std::tie(edge.triangle, edge.side, edge.begin); };
    std::sort(edges_.begin(), edges_.end(), [&](const SharpEdge& a, const SharpEdge& b) { return key(a) < key(b); });
    return std::move(edges_);
  }

 private:
  void list_sides() {
    for (uint32_t t = 0; t < mesh_.triangles().size(); ++t) {
      for (uint32_t side = 0; side < 3; ++side) add_side(t, side);
    }
    std::sort(sides_.begin(), sides_.end(), [](const EdgeSide& a, const EdgeSide& b) {
      return std::tie(a.key, a.triangle, a.side) < std::tie(b.key, b.triangle, b.side);
    });
    is_taken_.assign(sides_.size(), false);
  }

  void add_side(uint32_t triangle, uint32_t side) {
    const Triangle& corners = mesh_.triangles()[triangle];
    const Vec3 &from = mesh_.vertices()[corners[side]], &to = mesh_.vertices()[corners[(side + 1) % 3]];
    const Vec3 direction = one_way((to - from).normalized());
    const Vec3 foot = from - middle_ - direction.dot(from - middle_) * direction;
    const double a = direction.dot(from - middle_), b = direction.dot(to - middle_);
    // Any combination of coordinates serves in which lines seldom agree by chance.
    const double key = foot.dot(Vec3(0.7193, 0.5271, 0.4526));
    sides_.push_back({triangle, side, from, to, direction, foot, std::min(a, b), std::max(a, b), key});
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
    std::sort(line.begin(), line.end(), [&](size_t a, size_t b) { return sides_[a].low < sides_[b].low; });
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
    std::sort(ends.begin(), ends.end());
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

  // A face about an edge.
  struct Face {
    double angle;  // rad, about the edge
    Vec3 inward;
  };

  Vec3 inward_of(const EdgeSide& side) const {
    const Vec3& opposite = mesh_.vertices()[mesh_.triangles()[side.triangle][(side.side + 2) % 3]];
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
      if (std::none_of(faces.begin(), faces.end(), is_same)) faces.push_back({angle, inward});
    }
    std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.angle < b.angle; });
    return faces;
  }

  void take_stretch(const std::vector<size_t>& here, double low, double high) {
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

  void add_edge(const std::vector<size_t>& here, double low, double high, const std::array<Vec3, 2>& inward,
                const std::array<Vec3, 2>& normal) {
    const auto is_before = [&](size_t a, size_t b) { return sides_[a].triangle < sides_[b].triangle; };
    const EdgeSide& side = sides_[*std::min_element(here.begin(), here.end(), is_before)];
    const double length = side.high - side.low;
    double begin = std::clamp((low - side.low) / length, 0.0, 1.0), end = std::clamp((high - side.low) / length, 0.0, 1.0);
    if (!side.runs_along()) std::tie(begin, end) = std::make_tuple(1.0 - end, 1.0 - begin);
    edges_.push_back({side.triangle, side.side, begin, end, {inward[0], inward[1]}, {normal[0], normal[1]}});
  }

  const Mesh& mesh_;
  Vec3 middle_;
  double tolerance_;  // m
  std::vector<EdgeSide> sides_;
  std::vector<bool> is_taken_;
  std::vector<SharpEdge> edges_;
};

// Returns those on the triangles of a part, with their numbers in it.
std::vector<SharpEdge> edges_of_part(const std::vector<SharpEdge>& whole, const std::vector<uint32_t>& whole_triangle) {
  std::map<uint32_t, uint32_t> place;
  for (uint32_t t = 0; t < whole_triangle.size(); ++t) place[whole_triangle[t]] = t;
  std::vector<SharpEdge> edges;
  for (SharpEdge edge : whole) {
    const auto found = place.find(edge.triangle);
    if (found == place.end()) continue;
    edge.triangle = found->second;
    edges.push_back(edge);
  }
  return edges;
}

}  // namespace

std::vector<SharpEdge> find_sharp_edges(const Mesh& mesh) {
  std::vector<SharpEdge> edges = SharpEdgeFinder(mesh.surface()).find();
  return mesh.whole() ? edges_of_part(edges, mesh.whole_triangle()) : edges;
}

const SharpEdge* sharp_edge_at(std::span<const SharpEdge> edges, uint32_t triangle, double u, double v) {
  if (u != 0.0 && v != 0.0 && u + v != 1.0) return nullptr;
  const uint32_t side = v == 0.0 ? 0 : u == 0.0 ? 2 : 1;
  const double along = side == 0 ? u : side == 1 ? v : 1.0 - v;
  const auto is_before = [](const SharpEdge& edge, uint32_t wanted) { return edge.triangle < wanted; };
  auto edge = std::lower_bound(edges.begin(), edges.end(), triangle, is_before);
  for (; edge != edges.end() && edge->triangle == triangle; ++edge) {
    if (edge->side == side && edge->begin <= along && along <= edge->end) return &*edge;
  }
  return nullptr;
}

// The larger coordinate of the two that make 1 is rounded first; the other one then follows without rounding.
PointOnSide point_on_side(uint32_t side, double along) {
  if (side == 0) return {static_cast<float>(along), 0.0f};
  if (side == 2) return {0.0f, static_cast<float>(1.0 - along)};
  if (along >= 0.5) {
    const auto v = static_cast<float>(along);
    return {1.0f - v, v};
  }
  const auto u = static_cast<float>(1.0 - along);
  return {u, 1.0f - u};
}

}  // namespace echopath
