// The density of rays over directions, and where the rays of a plan go.
#include <gtest/gtest.h>

#include "echopath/trace/launch/launch.h"
#include "echopath/trace/launch/launch_directions.h"

namespace echopath::test_launch_directions {
namespace {

constexpr double kRounding = 1e-15;  // of unit vectors: a root and some products

Stratum cone(const Vec3& axis, double half_angle, double density) {
  Stratum stratum;
  stratum.axis = axis.normalized();
  stratum.versine = 1.0 - std::cos(half_angle);
  stratum.num_rays = 100;
  stratum.ray_density = density;
  return stratum;
}

// Equal areas: of an even set of the disc as many directions lie in each ring of equal solid angle.
TEST(LaunchDirections, OfAConeKeepAreas) {
  for (const double half_angle : {0.01, 1.0, 3.14159}) {
    const Stratum stratum = cone({1, 2, 3}, half_angle, 1.0);
    const LaunchDirections directions({stratum});
    for (const double share : {0.0, 0.1, 0.5, 0.9, 1.0}) {
      const Vec3 direction = directions.direction(0, {0.6 * std::sqrt(share), -0.8 * std::sqrt(share)});
      EXPECT_NEAR(direction.norm(), 1.0, kRounding);
      // A quarter of a turn about the axis stays one.
      const Vec3 turned = directions.direction(0, {0.8 * std::sqrt(share), 0.6 * std::sqrt(share)});
      EXPECT_LT((turned - stratum.axis.cross(direction) - stratum.axis.dot(direction) * stratum.axis).norm(), kRounding);
      EXPECT_NEAR(0.5 * (direction - stratum.axis).squaredNorm(), share * stratum.versine, kRounding);
    }
  }
}

// A strip: equal steps of x are equal azimuths, equal steps of y equal areas (Archimedes), and nothing leaves it.
TEST(LaunchDirections, OfAStripKeepAreas) {
  Stratum strip;
  strip.axis = Vec3(1, 2, 3).normalized();
  strip.across = strip.axis.unitOrthogonal();
  strip.half_azimuth = 0.8;
  strip.low = -0.1;
  strip.high = 0.3;
  EXPECT_NEAR(strip.solid_angle(), 1.6 * 0.4, kRounding);
  const LaunchDirections directions({strip});
  const Vec3 up = strip.axis.cross(strip.across);
  for (const double x : {-0.79, -0.2, 0.0, 0.5}) {
    for (const double y : {-0.19, 0.0, 0.19}) {
      const Vec3 direction = directions.direction(0, {x, y});
      EXPECT_NEAR(direction.norm(), 1.0, kRounding);
      EXPECT_NEAR(direction.dot(up), 0.1 + y, kRounding);
      EXPECT_NEAR(std::atan2(direction.dot(strip.across), direction.dot(strip.axis)), x, kRounding);
      EXPECT_TRUE(strip.contains(direction));
    }
  }
  EXPECT_FALSE(strip.contains(directions.direction(0, {0.81, 0.0})));
  EXPECT_FALSE(strip.contains(directions.direction(0, {0.0, 0.21})));
}

TEST(LaunchPlan, RaysInARowAreThoseOneByOne) {
  LaunchPlan plan;
  plan.batches = 2;
  plan.first_ray = {0};
  for (const int64_t count : {40, 0, 3, 200}) {
    plan.points.push_back(launch_points(Sampler::kLattice, LaunchDomain{}, count, {{0.3, 0.1}, {0.6, 0.9}}));
    plan.strata.emplace_back();
    plan.first_ray.push_back(plan.first_ray.back() + count);
  }
  for (int64_t begin = 0; begin + kPacketSize <= plan.first_ray.back(); begin += 5) {
    LaunchPlan::Places places;
    plan.place(begin, kPacketSize, places);
    for (int lane = 0; lane < kPacketSize; ++lane) {
      const int stratum = plan.stratum_of(begin + lane);
      EXPECT_EQ(places.strata[static_cast<size_t>(lane)], stratum);
      EXPECT_EQ(places.batches[static_cast<size_t>(lane)], plan.batch_of(stratum, begin + lane));
      EXPECT_EQ(Eigen::Vector2d(places.x[lane], places.y[lane]), plan.point_of(stratum, begin + lane));
    }
  }
}

}  // namespace
}  // namespace echopath::test_launch_directions
