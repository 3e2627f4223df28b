#include "echopath/trace/geometry/outer_points.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

namespace echopath {
namespace {

constexpr double kOnFace = 1e-6;   // of the distance from the middle of the polytope
constexpr double kFlat = 1e-12;    // of the cube of the longest edge: a tetrahedron of less volume counts as flat
constexpr size_t kFewPoints = 32;  // so few are all kept, as sorting them out saves nothing

// Directions from the centre of a cube to its faces, edges and corners have the components -1, 0 and 1. Their numbers have
// these as digits to the base 3, and kSteps are the values of the digits of x, y and z; kNowhere is the number of (0, 0, 0).
constexpr int kNumOutward = 27, kNowhere = 13;
constexpr std::array<int, 3> kSteps{1, 3, 9};

// Holds, by the number of the direction, the index of the outermost point, the first of several that are equally far out.
// At kNowhere stands the point of another direction, so that all entries are outermost points.
using Outermost = std::array<size_t, kNumOutward>;

Outermost outermost_of(const std::vector<Vec3>& points) {
  Outermost found{};
  for (int at = 0; at < kNowhere; ++at) {
    const int opposite = kNumOutward - 1 - at;
    const Vec3 outward = Eigen::Vector3i(at % 3 - 1, at / 3 % 3 - 1, at / 9 - 1).cast<double>();
    double farthest = outward.dot(points.front()), nearest = farthest;
    for (size_t i = 1; i < points.size(); ++i) {
      const double distance = outward.dot(points[i]);
      if (distance > farthest) {
        farthest = distance;
        found[at] = i;
      } else if (distance < nearest) {
        nearest = distance;
        found[opposite] = i;
      }
    }
  }
  found[kNowhere] = found[kNowhere - 1];
  return found;
}

// Holds the polytope of the outermost points as tetrahedra from its middle. Their outer faces are those into which the
// directions divide the sphere, drawn between the outermost points along them.
class InnerPolytope {
 public:
  InnerPolytope(const std::vector<Vec3>& points, const Outermost& outermost) {
    for (int at = 0; at < kNumOutward; ++at) {
      corners_[at] = points[outermost[at]];
      middle_ += corners_[at] / kNumOutward;
    }
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        if (a != b) add_tetrahedra(kSteps[a], kSteps[b], kSteps[3 - a - b]);
  }

  // `last` is the index of the tetrahedron that held the point before, which most often holds its neighbours, too.
  bool holds(const Vec3& point, size_t& last) const {
    const Vec3 offset = point - middle_;
    const auto is_in = [&](size_t i) {
      const Vec3 shares = inverses_[i] * offset;
      return shares.minCoeff() >= -kOnFace && shares.sum() <= 1.0 + kOnFace;
    };
    if (last < inverses_.size() && is_in(last)) return true;
    for (size_t i = 0; i < inverses_.size(); ++i) {
      if (!is_in(i)) continue;
      last = i;
      return true;
    }
    return false;
  }

 private:
  // Adds those between the middle of a face of the cube, of an edge of that face and a corner of that edge.
  void add_tetrahedra(int to_face, int to_edge, int to_corner) {
    for (const int face : {-to_face, to_face})
      for (const int edge : {-to_edge, to_edge})
        for (const int corner : {-to_corner, to_corner})
          add_tetrahedron(kNowhere + face, kNowhere + face + edge, kNowhere + face + edge + corner);
  }

  void add_tetrahedron(int a, int b, int c) {
    Mat3 edges;
    edges << corners_[a] - middle_, corners_[b] - middle_, corners_[c] - middle_;
    const double longest = edges.colwise().norm().maxCoeff();
    if (std::abs(edges.determinant()) > kFlat * longest * longest * longest) inverses_.push_back(edges.inverse());
  }

  std::array<Vec3, kNumOutward> corners_;
  Vec3 middle_ = Vec3::Zero();
  std::vector<Mat3> inverses_;  // offset from the middle -> shares of the three corners
};

}  // namespace

std::vector<Vec3> outer_points_of_hull(const std::vector<Vec3>& points) {
  if (points.size() <= kFewPoints) return points;
  const Outermost outermost = outermost_of(points);
  const InnerPolytope inner(points, outermost);
  std::vector<Vec3> outer;
  size_t last = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const bool is_corner = std::ranges::find(outermost, i) != outermost.end();
    if (is_corner || !inner.holds(points[i], last)) outer.push_back(points[i]);
  }
  return outer;
}

}  // namespace echopath
