// The density of rays over directions, and where the rays of a plan go.
#include <gtest/gtest.h>

#include "echopath/trace/launch.h"
#include "echopath/trace/launch_cones.h"

namespace echopath {
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

// Cones apart, across each other, one within another, one without rays, and the field of view.
std::vector<Stratum> some_strata() {
  std::vector<Stratum> strata = {cone({1, 0, 0}, 0.3, 1.0), cone({1, 0.4, 0}, 0.3, 2.0), cone({1, 0, 0}, 0.1, 4.0),
                                 cone({0, 0, 1}, 0.4, 8.0), cone({1, 0, 0}, 0.5, 16.0), cone({1, 0, 0}, 1.6, 32.0)};
  strata[4].num_rays = 0;
  return strata;
}

TEST(LaunchCones, DensityIsTheSumOfTheConesThatHoldTheDirection) {
  const std::vector<Stratum> strata = some_strata();
  const LaunchCones cones(strata);
  constexpr double kShare = 0.25;
  const auto points = disc_points(Sampler::kLattice, 300, {{0.2, 0.7}});
  for (int own = 0; own < static_cast<int>(strata.size()); ++own) {
    if (strata[static_cast<size_t>(own)].num_rays == 0) continue;
    for (int64_t i = 0; i < points->size(); ++i) {
      const Vec3 direction = cones.direction(own, points->point(i));
      double expected = 0.0, with_share = 0.0;
      for (size_t k = 0; k < strata.size(); ++k) {
        const double cosine = strata[k].axis.dot(direction);
        if (strata[k].num_rays == 0 || cosine < 1.0 - strata[k].versine) continue;
        expected += strata[k].ray_density;
        with_share += (k + 1 < strata.size() ? kShare : 1.0) * strata[k].ray_density;
      }
      EXPECT_DOUBLE_EQ(cones.density(direction), expected);
      EXPECT_DOUBLE_EQ(cones.density_of_ray(direction, own), expected);
      EXPECT_DOUBLE_EQ(cones.density_of_ray(direction, own, kShare), with_share);
    }
  }
}

// At the rim of a cone its own rays are inside, whatever rounding says.
TEST(LaunchCones, RaysAtTheRimAreOfTheirCone) {
  const std::vector<Stratum> strata = {cone({1, 2, 3}, 0.1, 3.0), cone({-1, 0, 0}, 0.1, 5.0)};
  const LaunchCones cones(strata);
  for (int i = 0; i < 100; ++i) {
    const Vec3 direction = cones.direction(0, {std::cos(0.1 * i), std::sin(0.1 * i)});
    EXPECT_EQ(cones.density_of_ray(direction, 0), 3.0) << i;
  }
}

// Equal areas: of an even set of the disc as many directions lie in each ring of equal solid angle.
TEST(LaunchCones, ProjectionKeepsAreas) {
  for (const double half_angle : {0.01, 1.0, 3.14159}) {
    const Stratum stratum = cone({1, 2, 3}, half_angle, 1.0);
    const ConeFrame frame(stratum);
    for (const double share : {0.0, 0.1, 0.5, 0.9, 1.0}) {
      const Vec3 direction = packed(frame.direction(0.6 * std::sqrt(share), -0.8 * std::sqrt(share)));
      EXPECT_NEAR(direction.norm(), 1.0, kRounding);
      // A quarter of a turn about the axis stays one.
      const Vec3 turned = packed(frame.direction(0.8 * std::sqrt(share), 0.6 * std::sqrt(share)));
      EXPECT_LT((turned - stratum.axis.cross(direction) - stratum.axis.dot(direction) * stratum.axis).norm(), kRounding);
      EXPECT_NEAR(0.5 * (direction - stratum.axis).squaredNorm(), share * stratum.versine, kRounding);
    }
  }
}

TEST(LaunchPlan, RaysInARowAreThoseOneByOne) {
  LaunchPlan plan;
  plan.batches = 2;
  plan.first_ray = {0};
  for (const int64_t count : {40, 0, 3, 200}) {
    plan.points.push_back(disc_points(Sampler::kLattice, count, {{0.3, 0.1}, {0.6, 0.9}}));
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
}  // namespace echopath
