// Points of reflection, against images in planes and the nearest points of a sphere.
#include <gtest/gtest.h>

#include <cmath>

#include "echopath/scene/smooth/reflection_point.h"
#include "echopath/scene/smooth/smooth.h"

namespace echopath::test_reflection_point {
namespace {

constexpr double kRounding = 1e-12;
constexpr double kSphere = 2e-3;     // m: corners 6 degrees apart tell a sphere of 1 m to the fourth power of that
constexpr double kCurvature = 0.03;  // relative, of normals that are interpolated linearly over as much

ReflectingTriangle on_floor(double size) {
  const std::array<Vec3, 3> corners = {Vec3(-size, -size, 0), Vec3(size, -size, 0), Vec3(0, 2 * size, 0)};
  return reflecting_triangle(corners, {Vec3::UnitZ(), Vec3::UnitZ(), Vec3::UnitZ()});
}

TEST(ReflectionPoint, OfAPlaneLiesOnTheLineToTheImage) {
  const Vec3 first(-3, 0.4, 2), second(4, -0.2, 1), image(4, -0.2, -1);
  const auto found = find_reflection(on_floor(10), first, second);
  ASSERT_TRUE(found);
  const Vec3 expected = first + 2.0 / 3.0 * (image - first);
  EXPECT_LT((found->position - expected).norm(), kRounding);
  // Across the plane of incidence the second derivative of the path length is 1/r1 + 1/r2, along it cos^2 of the incidence
  // times that.
  const double here = (first - expected).norm(), there = (second - expected).norm(), cosine = 2.0 / here;
  const double bend = 1.0 / here + 1.0 / there;
  EXPECT_NEAR(found->second_derivatives[0], cosine * cosine * bend, kRounding);
  EXPECT_NEAR(found->second_derivatives[1], bend, kRounding);
  EXPECT_NEAR(std::abs(found->axes[1].dot((second - first).cross(Vec3::UnitZ()).normalized())), 1.0, kRounding);
}

// Between antennas that see each other over the surface, the line that halves the angle turns fast from place to place.
TEST(ReflectionPoint, IsFoundAtAnyAngleAnywhereInTheTriangle) {
  for (const double height : {0.05, 0.3, 1.0, 5.0}) {
    for (const double across : {-1.9, -1.0, 0.0, 1.0, 1.9}) {
      const std::array<Vec3, 3> corners = {Vec3(0, across - 2.0, 0), Vec3(2.165, across + 2.0, 0),
                                           Vec3(-2.165, across + 2.0, 0)};
      const auto found = find_reflection(reflecting_triangle(corners, {Vec3::UnitZ(), Vec3::UnitZ(), Vec3::UnitZ()}),
                                         Vec3(-10, 0, height), Vec3(10, 0, height));
      ASSERT_TRUE(found) << height << " " << across;
      EXPECT_LT(found->position.norm(), kRounding);
    }
  }
}

TEST(ReflectionPoint, IsNotBesideTheTriangleNorBetweenItsSides) {
  EXPECT_FALSE(find_reflection(on_floor(0.1), Vec3(-3, 0.4, 2), Vec3(4, -0.2, 1)));
  EXPECT_FALSE(find_reflection(on_floor(10), Vec3(0, 0, 2), Vec3(0, 0, -2)));
}

TEST(ReflectionPoint, OfASphereIsTheNearestPoint) {
  const auto at = [](double a, double b) -> Vec3 {
    return {std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b)};
  };
  const std::array<Vec3, 3> corners = {at(0, 0), at(0.1, 0.02), at(-0.01, 0.1)};
  const ReflectingTriangle triangle = reflecting_triangle(corners, corners);
  const double distance = 4.0;
  const Vec3 nearest = at(0.03, 0.04), antenna = (1.0 + distance) * nearest;
  const auto found = find_reflection(triangle, antenna, antenna);
  ASSERT_TRUE(found);
  EXPECT_LT((found->position - nearest).norm(), kSphere);
  for (const double bend : found->second_derivatives) EXPECT_NEAR(bend / (2.0 * (1.0 / distance + 1.0)), 1.0, kCurvature);
  EXPECT_FALSE(find_reflection(triangle, 5.0 * at(0.5, 0.04), 5.0 * at(0.5, 0.04)));
}

TEST(ReflectionPoint, OfACreaseIsThatOfItsFacet) {
  const std::array<Vec3, 3> corners = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const ReflectingTriangle triangle =
      reflecting_triangle(corners, {Vec3(1, 0, 1).normalized(), Vec3::UnitZ(), Vec3::UnitZ()});
  EXPECT_TRUE(triangle.is_flat());
}

}  // namespace
}  // namespace echopath::test_reflection_point
