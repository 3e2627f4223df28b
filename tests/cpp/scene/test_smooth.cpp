// The curved surface behind a mesh, on surfaces whose normals and curvatures are known.
#include <gtest/gtest.h>

#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/scene/smooth/smooth.h"

namespace echopath::test_smooth {
namespace {

constexpr double kRounding = 1e-14;

// A triangle on a surface of revolution or sphere, from a map of two parameters.
template <class Map>
std::array<Vec3, 3> triangle(const Map& map, double a, double b, double size) {
  return {map(a, b), map(a + size, b + 0.2 * size), map(a - 0.1 * size, b + size)};
}

Vec3 on_sphere(double a, double b) { return {std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b)}; }

TEST(VertexNormals, AreExactOnASphereOfAnyTessellation) {
  // An irregular fan of points on a sphere around the pole.
  std::vector<Vec3> vertices = {{0, 0, 1}};
  std::vector<Triangle> triangles;
  const double angles[] = {0.0, 0.9, 2.0, 2.7, 4.4, 5.1}, reach[] = {0.3, 0.5, 0.2, 0.6, 0.4, 0.35};
  for (int i = 0; i < 6; ++i) {
    vertices.push_back(
        {std::sin(reach[i]) * std::cos(angles[i]), std::sin(reach[i]) * std::sin(angles[i]), std::cos(reach[i])});
  }
  for (uint32_t i = 0; i < 6; ++i) triangles.push_back({0, 1 + i, 1 + (i + 1) % 6});
  EXPECT_LT((vertex_normals(vertices, triangles)[0] - Vec3::UnitZ()).norm(), kRounding);
}

// Returns a closed cylinder of radius 1 about z, with vertices at its two rims alone and fans for caps.
std::pair<std::vector<Vec3>, std::vector<Triangle>> capped_cylinder(uint32_t segments, double height) {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  for (const double z : {0.0, height}) {
    for (uint32_t k = 0; k < segments; ++k) {
      const double angle = 2.0 * kPi * k / segments;
      vertices.emplace_back(std::cos(angle), std::sin(angle), z);
    }
  }
  for (uint32_t k = 0; k < segments; ++k) {
    const uint32_t next = (k + 1) % segments;
    triangles.push_back({k, next, segments + next});
    triangles.push_back({k, segments + next, segments + k});
    if (k > 0 && k + 1 < segments) {
      triangles.push_back({0, k + 1, k});
      triangles.push_back({segments, segments + k, segments + k + 1});
    }
  }
  return {vertices, triangles};
}

// Facets of a cap are flat by themselves and leave the rim to the side.
TEST(VertexNormals, OfARimAreThoseOfTheCurvedSide) {
  for (const double height : {0.05, 40.0}) {
    const auto [vertices, triangles] = capped_cylinder(12, height);
    const std::vector<Vec3> normals = vertex_normals(vertices, triangles, find_creases(vertices, triangles));
    // Facets of 15 degrees either way have weights that differ with their diagonals.
    for (size_t v = 0; v < vertices.size(); ++v) {
      EXPECT_NEAR(normals[v].z(), 0.0, kRounding);
      EXPECT_GT(normals[v].dot(Vec3(vertices[v].x(), vertices[v].y(), 0.0)), std::cos(0.07)) << height;
    }
  }
}

TEST(VertexNormals, OfABoxFitNoneOfItsFacets) {
  const auto [vertices, triangles] = capped_cylinder(4, 1.0);
  const std::vector<Vec3> normals = vertex_normals(vertices, triangles, find_creases(vertices, triangles));
  for (const Triangle& triangle : triangles) {
    const Vec3 facet = (vertices[triangle[1]] - vertices[triangle[0]]).cross(vertices[triangle[2]] - vertices[triangle[0]]);
    const std::array<Vec3, 3> corners = {normals[triangle[0]], normals[triangle[1]], normals[triangle[2]]};
    EXPECT_FALSE(is_smooth_facet(facet.normalized(), corners));
  }
}

TEST(SmoothPoint, PositionOnASphereErrsWithTheFourthPower) {
  double errors[2];
  for (int i = 0; i < 2; ++i) {
    const double size = i == 0 ? 0.2 : 0.1;
    const auto corners = triangle(on_sphere, 0.3, 0.4, size);
    errors[i] = std::abs(smooth_point(corners, corners, 0.3, 0.25).position.norm() - 1.0);
  }
  EXPECT_LT(errors[0], 1e-4);
  EXPECT_GT(errors[0] / errors[1], 12.0);
}

TEST(SmoothPoint, CurvatureIsThatOfTheSphere) {
  constexpr double kRadius = 2.5;
  auto normals = triangle(on_sphere, 0.3, 0.4, 0.02);
  auto corners = normals;
  for (Vec3& corner : corners) corner *= kRadius;
  const SmoothPoint point = smooth_point(corners, normals, 0.3, 0.3);
  const Mat3 expected = (Mat3::Identity() - point.normal * point.normal.transpose()) / kRadius;
  EXPECT_LT((point.curvature - expected).norm(), 1e-3 / kRadius);
  EXPECT_LT((point.curvature * point.normal).norm(), kRounding);
}

TEST(SmoothPoint, CylinderIsFlatAlongItsAxis) {
  constexpr double kRadius = 0.5;
  const auto on_cylinder = [](double a, double b) -> Vec3 { return {kRadius * std::cos(a), kRadius * std::sin(a), b}; };
  const auto corners = triangle(on_cylinder, 0.7, 0.0, 0.02);
  std::array<Vec3, 3> normals;
  for (size_t i = 0; i < 3; ++i) normals[i] = Vec3(corners[i].x(), corners[i].y(), 0).normalized();
  const SmoothPoint point = smooth_point(corners, normals, 0.2, 0.4);
  const Vec3 around = Vec3::UnitZ().cross(point.normal);
  EXPECT_LT(std::abs(Vec3::UnitZ().dot(point.curvature * Vec3::UnitZ())), kRounding);
  EXPECT_NEAR(around.dot(point.curvature * around), 1.0 / kRadius, 1e-3);
}

TEST(SmoothPoint, CreaseGuardRefusesABox) {
  const Vec3 facet = Vec3::UnitZ(), corner_normal = Vec3::Ones().normalized();
  EXPECT_TRUE(is_smooth_facet(facet, {facet, facet, Vec3(0.1, 0.2, 1.0).normalized()}));
  EXPECT_FALSE(is_smooth_facet(facet, {facet, facet, corner_normal}));
}

}  // namespace
}  // namespace echopath::test_smooth
