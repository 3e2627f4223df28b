#include "echopath/scene/smooth/tessellation.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "echopath/base/disjoint_sets.h"

namespace echopath {
namespace {

constexpr double kFlatAngle = 1e-3;    // rad: neighbours that turn by less are one plane
constexpr double kCreaseAngle = 0.7;   // rad (40 degrees): neighbours that turn by more meet in an edge that is meant
constexpr double kCurvedShare = 0.05;  // of a piece's area, below it the piece counts as flat
constexpr double kOneSided = 0.6;      // |sum of turns| / sum: a facet that turns on one side only lies at a bend

// Describes an edge with two facets.
struct Turn {
  uint32_t first, second;
  double angle;  // rad
  Vec3 across;   // out of the first facet, as long as the edge
};

struct HalfEdge {
  uint32_t low, high, facet, side;
};

double weighted_median(const std::vector<double>& values, const std::vector<double>& weights, size_t& index) {
  std::vector<size_t> order(values.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::ranges::stable_sort(order, {}, [&](size_t i) { return values[i]; });
  const double half = 0.5 * std::accumulate(weights.begin(), weights.end(), 0.0);
  double sum = 0.0;
  for (const size_t i : order) {
    index = i;
    sum += weights[i];
    if (sum >= half) break;
  }
  return values[index];
}

class TessellationMeter {
 public:
  explicit TessellationMeter(const Mesh& mesh) : mesh_(mesh) {
    for (const Triangle& t : mesh.triangles()) {
      const Vec3 cross = (corner(t[1]) - corner(t[0])).cross(corner(t[2]) - corner(t[0]));
      const double size = cross.norm();
      areas_.push_back(0.5 * size);
      normals_.push_back(cross / size);
    }
  }

  std::optional<Tessellation> measure() {
    if (mesh_.is_flat()) return std::nullopt;
    find_turns();
    std::vector<bool> is_curved = find_curved();
    leave_flat_pieces_out(is_curved);
    Tessellation out;
    out.area = std::accumulate(areas_.begin(), areas_.end(), 0.0);
    for (size_t f = 0; f < areas_.size(); ++f) out.curved_area += is_curved[f] ? areas_[f] : 0.0;
    if (out.curved_area == 0.0) return std::nullopt;
    summarise(is_curved, out);
    return out;
  }

 private:
  const Vec3& corner(uint32_t vertex) const { return mesh_.vertices()[vertex]; }
  static bool is_soft(const Turn& turn) { return turn.angle > kFlatAngle && turn.angle < kCreaseAngle; }

  void find_turns() {
    std::vector<HalfEdge> edges;
    for (uint32_t f = 0; f < normals_.size(); ++f) {
      const Triangle& t = mesh_.triangles()[f];
      for (uint32_t side = 0; side < 3; ++side) {
        const auto [low, high] = std::minmax(t[(side + 1) % 3], t[(side + 2) % 3]);
        edges.push_back({low, high, f, side});
      }
    }
    const auto key = [](const HalfEdge& edge) {
      return std::array<uint32_t, 4>{edge.low, edge.high, edge.side, edge.facet};
    };
    std::ranges::sort(edges, {}, key);
    for (size_t i = 1; i < edges.size(); ++i) {
      if (edges[i].low == edges[i - 1].low && edges[i].high == edges[i - 1].high) add_turn(edges[i - 1], edges[i]);
    }
  }

  void add_turn(const HalfEdge& one, const HalfEdge& two) {
    const Triangle& t = mesh_.triangles()[one.facet];
    const Vec3 along = corner(t[(one.side + 2) % 3]) - corner(t[(one.side + 1) % 3]);
    const Vec3 &first = normals_[one.facet], &second = normals_[two.facet];
    turns_.push_back({one.facet, two.facet, std::atan2(first.cross(second).norm(), first.dot(second)), along.cross(first)});
  }

  // Marks the facets that turn, alone or with a neighbour in their plane, on more than one side.
  std::vector<bool> find_curved() const {
    std::vector<Vec3> outward(areas_.size(), Vec3::Zero());
    std::vector<double> weight(areas_.size(), 0.0);
    for (const Turn& turn : turns_) {
      if (!is_soft(turn)) continue;
      outward[turn.first] += turn.across;
      outward[turn.second] -= turn.across;
      for (const uint32_t facet : {turn.first, turn.second}) weight[facet] += turn.across.norm();
    }
    std::vector<Vec3> plane_outward = outward;
    std::vector<double> plane_weight = weight;
    for (const Turn& turn : turns_) {
      if (turn.angle > kFlatAngle) continue;
      plane_outward[turn.first] += outward[turn.second];
      plane_outward[turn.second] += outward[turn.first];
      plane_weight[turn.first] += weight[turn.second];
      plane_weight[turn.second] += weight[turn.first];
    }
    std::vector<bool> is_curved(areas_.size());
    for (size_t f = 0; f < areas_.size(); ++f)
      is_curved[f] = weight[f] > 0 && plane_outward[f].norm() < kOneSided * plane_weight[f];
    return is_curved;
  }

  // Takes the mark from the facets of pieces that count as flat. A piece is what edges hold together: a body and the road
  // below it are two, even where one mesh holds both, so that the area of the road does not make the body a trifle.
  void leave_flat_pieces_out(std::vector<bool>& is_curved) const {
    const std::vector<uint32_t> piece = find_pieces();
    std::vector<double> area(areas_.size(), 0.0), curved(areas_.size(), 0.0);
    for (size_t f = 0; f < areas_.size(); ++f) {
      area[piece[f]] += areas_[f];
      curved[piece[f]] += is_curved[f] ? areas_[f] : 0.0;
    }
    for (size_t f = 0; f < areas_.size(); ++f) {
      if (curved[piece[f]] < kCurvedShare * area[piece[f]]) is_curved[f] = false;
    }
  }

  // Returns the piece of each facet, named by one of its facets.
  std::vector<uint32_t> find_pieces() const {
    DisjointSets pieces(areas_.size());
    for (const Turn& turn : turns_) pieces.join(turn.first, turn.second);
    return pieces.names();
  }

  void summarise(const std::vector<bool>& is_curved, Tessellation& out) const {
    std::vector<Mat3> tensors(areas_.size(), Mat3::Zero());
    for (const Turn& turn : turns_) {
      if (!is_soft(turn)) continue;
      const Mat3 term = (0.5 * turn.angle / turn.across.norm()) * turn.across * turn.across.transpose();
      for (const uint32_t facet : {turn.first, turn.second}) tensors[facet] += term / areas_[facet];
    }
    std::vector<double> squared_ratios, curvatures, areas;
    for (size_t f = 0; f < areas_.size(); ++f) {
      if (!is_curved[f]) continue;
      squared_ratios.push_back(12.0 * tensors[f].cwiseProduct(moments_of(f)).sum());  // edge^2 / radius in m
      curvatures.push_back(Eigen::SelfAdjointEigenSolver<Mat3>(tensors[f], Eigen::EigenvaluesOnly).eigenvalues()[2]);
      areas.push_back(areas_[f]);
    }
    size_t index = 0;
    out.radius = 1.0 / weighted_median(curvatures, areas, index);
    out.edge = std::sqrt(weighted_median(squared_ratios, areas, index) * out.radius);
  }

  // Returns the second moments of a facet about its middle, in m^2.
  Mat3 moments_of(size_t facet) const {
    const Triangle& t = mesh_.triangles()[facet];
    const Vec3 middle = (corner(t[0]) + corner(t[1]) + corner(t[2])) / 3.0;
    Mat3 moments = Mat3::Zero();
    for (const uint32_t vertex : t) moments += (corner(vertex) - middle) * (corner(vertex) - middle).transpose() / 12.0;
    return moments;
  }

  const Mesh& mesh_;
  std::vector<double> areas_;
  std::vector<Vec3> normals_;
  std::vector<Turn> turns_;
};

}  // namespace

std::optional<Tessellation> tessellation_of(const Mesh& mesh) { return TessellationMeter(mesh).measure(); }

}  // namespace echopath
