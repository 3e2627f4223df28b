#include "echopath/trace/embree/tree_shape.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace echopath {
namespace {

// A fitted tree takes rays 10 % longer than a new one where its edges have turned by 0.3 rad from those it was grown over
// (root mean square), and 50 % longer at 1.2.
constexpr double kMostBent = 0.1;      // sine squared of the turn
constexpr double kSameScale = 1e-6;    // relative
constexpr double kLeastExtent = 1e-6;  // of a mesh across its longest extent, relative to that

Mat3 right_handed(const Vec3& first, const Vec3& second) {
  Mat3 axes;
  axes << first, second, first.cross(second);
  return axes;
}

TreeShape turned(const Mat3& rotation) {
  TreeShape shape;
  shape.is_present = false;
  for (int i = 0; i < 9; ++i) {
    shape.turn[i] = static_cast<int8_t>(std::lround(rotation.data()[i] / TreeShape::kTurnStep));
  }
  return shape;
}

}  // namespace

Mat3 TreeShape::rotation() const {
  Mat3 rotation;
  for (int i = 0; i < 9; ++i) rotation.data()[i] = kTurnStep * turn[i];
  return rotation;
}

TreeShape shape_of_rigid(const Mesh& mesh, const Mat3& linear, const std::vector<Vec3>& vertices) {
  const Mat3 gram = linear.transpose() * linear;
  const double scale_squared = gram.trace() / 3.0;
  const bool is_even = (gram - scale_squared * Mat3::Identity()).cwiseAbs().maxCoeff() <= kSameScale * scale_squared;
  return is_even ? turned(linear / std::sqrt(scale_squared)) : shape_of_deformed(mesh, vertices);
}

// Finds the rotation that takes the edges at rest next to those of now (Kabsch 1976), and what is left of their difference.
TreeShape shape_of_deformed(const Mesh& mesh, const std::vector<Vec3>& vertices) {
  const std::vector<Vec3>& at_rest = mesh.vertices();
  Mat3 products = Mat3::Zero();
  double squares = 0.0, squares_at_rest = 0.0;
  for (const auto& [a, b, c] : mesh.triangles()) {
    for (const uint32_t end : {b, c}) {
      const Vec3 edge = vertices[end] - vertices[a], edge_at_rest = at_rest[end] - at_rest[a];
      products += edge * edge_at_rest.transpose();
      squares += edge.squaredNorm();
      squares_at_rest += edge_at_rest.squaredNorm();
    }
  }
  const Mat3 gram = products.transpose() * products;
  const Eigen::SelfAdjointEigenSolver<Mat3> found(gram);
  const Vec3 sizes = found.eigenvalues().cwiseMax(0.0).cwiseSqrt();  // ascending
  if (!(sizes[1] > kLeastExtent * sizes[2])) return {};
  const double aligned = sizes[2] + sizes[1] + std::copysign(sizes[0], products.determinant());
  if (!(aligned * aligned >= (1.0 - kMostBent) * squares * squares_at_rest)) return {};
  const Mat3 axes = right_handed(found.eigenvectors().col(2), found.eigenvectors().col(1));
  return turned(right_handed(products * axes.col(0) / sizes[2], products * axes.col(1) / sizes[1]) * axes.transpose());
}

}  // namespace echopath
