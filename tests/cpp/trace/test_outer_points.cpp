// Points that outlines may depend on.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <random>
#include <vector>

#include "echopath/trace/geometry/outer_points.h"
#include "echopath/trace/strata/fit_stratum.h"

namespace echopath::test_outer_points {
namespace {

constexpr double kOnFace = 2e-6;  // of the size of a body
const Mat3 kTurned =
    (Eigen::AngleAxisd(0.7, Vec3::UnitZ()) * Eigen::AngleAxisd(0.2, Vec3(1, 2, 0).normalized())).toRotationMatrix();

// Vertices every `step` of the six sides of a turned box of 12 x 8 x 5 m, which lie on its faces within rounding.
std::vector<Vec3> vertices_of_box(double step) {
  std::vector<Vec3> vertices;
  const Vec3 half(6, 4, 2.5);
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const double side : {-1.0, 1.0})
      for (double a = -half[u]; a <= half[u]; a += step)
        for (double b = -half[v]; b <= half[v]; b += step) {
          Vec3 vertex;
          vertex[axis] = side * half[axis];
          vertex[u] = a;
          vertex[v] = b;
          vertices.push_back(kTurned * vertex + Vec3(20, 3, 1));
        }
  }
  return vertices;
}

std::vector<Vec3> vertices_of_ball(int count) {
  std::mt19937 random(3);
  std::normal_distribution<double> draw;
  std::vector<Vec3> vertices;
  for (int i = 0; i < count; ++i)
    vertices.push_back(Vec3(9, -4, 0) + 2.0 * Vec3(draw(random), draw(random), draw(random)).normalized());
  return vertices;
}

// A tree, a car: most vertices lie within.
std::vector<Vec3> vertices_of_cloud(int count) {
  std::mt19937 random(5);
  std::normal_distribution<double> draw;
  std::vector<Vec3> vertices;
  for (int i = 0; i < count; ++i) vertices.push_back(Vec3(15 + draw(random), 2 * draw(random), 0.5 * draw(random)));
  return vertices;
}

double farthest(const std::vector<Vec3>& points, const Vec3& outward) {
  double most = outward.dot(points.front());
  for (const Vec3& point : points) most = std::max(most, outward.dot(point));
  return most;
}

// The hull of the points that are left reaches as far in every direction as that of all.
void expect_same_hull(const std::vector<Vec3>& all, double tolerance) {
  const std::vector<Vec3> outer = outer_points_of_hull(all);
  std::mt19937 random(11);
  std::normal_distribution<double> draw;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 outward = Vec3(draw(random), draw(random), draw(random)).normalized();
    ASSERT_NEAR(farthest(outer, outward), farthest(all, outward), tolerance) << i;
  }
}

TEST(OuterPoints, OfABoxItsCornersAreLeftHoweverItIsCut) {
  const std::vector<Vec3> all = vertices_of_box(0.5);
  std::vector<Vec3> outer = outer_points_of_hull(all);
  // Each corner belongs to three sides.
  EXPECT_EQ(all.size(), 2 * (25 * 17 + 17 * 11 + 11 * 25));
  EXPECT_LE(outer.size(), 24u);
  std::ranges::for_each(outer, [](Vec3& point) {
    point = kTurned.transpose() * (point - Vec3(20, 3, 1));
    EXPECT_NEAR((point.cwiseAbs() - Vec3(6, 4, 2.5)).norm(), 0.0, 12 * kOnFace);
  });
  expect_same_hull(all, 12 * kOnFace);
}

TEST(OuterPoints, NothingThatAHullDependsOnIsLeftOut) {
  expect_same_hull(vertices_of_ball(3000), 0.0);
  expect_same_hull(vertices_of_cloud(5000), 0.0);
  EXPECT_LT(outer_points_of_hull(vertices_of_cloud(5000)).size(), 1000u);
}

TEST(OuterPoints, FlatAndSmallBodiesStayWhole) {
  std::vector<Vec3> plate;
  for (int i = 0; i < 400; ++i) plate.emplace_back(i % 20, i / 20, 0.0);
  EXPECT_EQ(outer_points_of_hull(plate), plate);
  EXPECT_EQ(outer_points_of_hull(std::vector<Vec3>(100, Vec3(1, 2, 3))).size(), 100u);
  EXPECT_TRUE(outer_points_of_hull({}).empty());
}

// From far, and so near that the middle of the box lies too far aside.
TEST(OuterPoints, StrataAreThoseOfAllPoints) {
  for (const std::vector<Vec3>& all : {vertices_of_ball(3000), vertices_of_cloud(5000)}) {
    for (const Vec3& apex : {Vec3(0, 0, 0), Vec3(9, -6.02, 0.3), Vec3(-400, 90, 7)}) {
      const auto of_all = fit_stratum(all, apex, "body", 24),
                 of_outer = fit_stratum(outer_points_of_hull(all), apex, "body", 24);
      ASSERT_EQ(of_all.has_value(), of_outer.has_value());
      if (!of_all) continue;
      EXPECT_EQ(of_all->axis, of_outer->axis);
      EXPECT_EQ(of_all->solid_angle(), of_outer->solid_angle());
    }
  }
}

}  // namespace
}  // namespace echopath::test_outer_points
