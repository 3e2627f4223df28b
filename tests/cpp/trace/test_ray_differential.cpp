// Ray tubes behind curved mirrors against geometrical optics in closed form.
#include <gtest/gtest.h>

#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/trace/sbr/ray_differential.h"

namespace echopath::test_ray_differential {
namespace {

constexpr double kTubeTolerance = 1e-7;  // relative; a finite-difference ray tracing agrees with the closed form to that
constexpr double kRounding = 1e-12;      // m^2, of areas of some tens
constexpr double kLastDigit = 1e-3;      // m, as printed

// Tube of a point source `distance` before a sphere of signed radius (positive: convex) at `angle`, reflected.
struct Reflected {
  RayDifferential rays;
  Vec3 direction;
};

Reflected at_sphere(double distance, double radius, double angle) {
  const Vec3 normal = Vec3::UnitZ(), direction(std::sin(angle), 0.0, -std::cos(angle));
  Reflected out{RayDifferential::from_point(direction), direction};
  out.rays.transfer(direction, distance, normal);
  const Mat3 curvature = (Mat3::Identity() - normal * normal.transpose()) / radius;
  out.rays.reflect(direction, normal, curvature);
  out.direction = direction - 2.0 * direction.dot(normal) * normal;
  return out;
}

// D = L^2 (1 + s/rho1)(1 + s/rho2), 1/rho1 = 1/L + 2/(a cos), 1/rho2 = 1/L + 2 cos/a.
double closed_form(double distance, double radius, double angle, double further) {
  const double rho1 = 1.0 / (1.0 / distance + 2.0 / (radius * std::cos(angle)));
  const double rho2 = 1.0 / (1.0 / distance + 2.0 * std::cos(angle) / radius);
  return distance * distance * (1.0 + further / rho1) * (1.0 + further / rho2);
}

TEST(RayDifferential, PointSourceSpreadsWithTheSquareOfTheDistance) {
  const Vec3 direction = Vec3(1, 2, -2).normalized();
  EXPECT_NEAR(std::abs(RayDifferential::from_point(direction).area(direction, 7.0)), 49.0, kRounding);
}

TEST(RayDifferential, ConvexSphereDivergesAsGeometricalOpticsSays) {
  // The sphere's centre 10 m away: the surface is met after 9.93 m.
  const double to_surface = -0.1 * std::cos(kPi / 4) + std::sqrt(100.0 - std::pow(0.1 * std::sin(kPi / 4), 2));
  const Reflected oblique = at_sphere(to_surface, 0.1, kPi / 4);
  EXPECT_NEAR(std::sqrt(std::abs(oblique.rays.area(oblique.direction, 5.0))), 1008.725, kLastDigit);
  for (const double angle : {0.0, 0.3, kPi / 4, 1.2}) {
    for (const double radius : {0.1, 2.0}) {
      const Reflected out = at_sphere(10.0, radius, angle);
      const double expected = closed_form(10.0, radius, angle, 5.0);
      EXPECT_NEAR(std::abs(out.rays.area(out.direction, 5.0)) / expected, 1.0, kTubeTolerance);
      EXPECT_EQ(out.rays.num_caustics(out.direction, 5.0), 0);
    }
  }
}

TEST(RayDifferential, FlatMirrorsChangeNothing) {
  const Reflected out = at_sphere(3.0, 1e30, 0.8);
  EXPECT_NEAR(std::abs(out.rays.area(out.direction, 4.0)), 49.0, kRounding);
}

// A concave sphere focuses at 1/rho = 2/(a cos) - 1/L and 2 cos/a - 1/L; each passage is a caustic.
TEST(RayDifferential, ConcaveMirrorHasTwoCaustics) {
  const double distance = 3.0, radius = 1.0, angle = 0.4;
  const double first = 1.0 / (2.0 / (radius * std::cos(angle)) - 1.0 / distance);
  const double second = 1.0 / (2.0 * std::cos(angle) / radius - 1.0 / distance);
  ASSERT_LT(first, second);
  const Reflected out = at_sphere(distance, -radius, angle);
  EXPECT_EQ(out.rays.num_caustics(out.direction, 0.99 * first), 0);
  EXPECT_EQ(out.rays.num_caustics(out.direction, 1.01 * first), 1);
  EXPECT_EQ(out.rays.num_caustics(out.direction, 0.99 * second), 1);
  EXPECT_EQ(out.rays.num_caustics(out.direction, 1.01 * second), 2);
  const double further = 5.0;
  const double expected = distance * distance * (1.0 - further / first) * (1.0 - further / second);
  EXPECT_NEAR(std::abs(out.rays.area(out.direction, further)) / std::abs(expected), 1.0, kTubeTolerance);
}

}  // namespace
}  // namespace echopath::test_ray_differential
