// Strata of rays against the areas that they hold on the sphere.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "echopath/base/constants.h"
#include "echopath/record/stratum.h"

namespace echopath::test_stratum {
namespace {

constexpr int kSteps = 300;        // of the height and of the azimuth of directions, in each of which areas are equal
constexpr double kOfCells = 0.01;  // of the solid angle, by cells that a border cuts

double area_on_sphere(const Stratum& stratum) {
  int inside = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double height = 2.0 * (i + 0.5) / kSteps - 1.0, level = std::sqrt(1.0 - height * height);
    for (int j = 0; j < kSteps; ++j) {
      const double azimuth = kTwoPi * (j + 0.5) / kSteps;
      inside += stratum.contains(Vec3(level * std::cos(azimuth), level * std::sin(azimuth), height));
    }
  }
  return 4.0 * kPi * inside / (double{kSteps} * kSteps);
}

TEST(Stratum, ContainsItsSolidAngle) {
  Stratum cone;
  cone.axis = Vec3(1.0, 2.0, -0.5).normalized();
  cone.versine = versine_of(0.6);
  Stratum strip;
  strip.axis = Vec3(0.8, 0.6, 0.0);
  strip.across = Vec3(-0.6, 0.8, 0.0);
  strip.half_azimuth = 0.7;
  strip.low = -0.2;
  strip.high = 0.6;
  for (const Stratum& stratum : {cone, strip})
    EXPECT_NEAR(area_on_sphere(stratum) / stratum.solid_angle(), 1.0, kOfCells) << stratum.is_strip();
  EXPECT_NEAR(cone.solid_angle(), kTwoPi * (1.0 - std::cos(0.6)), 1e-12);
}

TEST(Stratum, RaysOfAFocusCountForTheStratumThatItIsIn) {
  std::vector<Stratum> strata(3);
  strata[0].name = "field of view";
  strata[1].name = "car";
  strata[2].name = "car, focus 1";
  strata[2].focus_of = 1;
  for (size_t k = 0; k < 3; ++k) strata[k].num_rays = 10 << k;
  EXPECT_EQ(shares_of(strata), (RayShares{{"field of view", 10.0}, {"car", 60.0}}));
}

}  // namespace
}  // namespace echopath::test_stratum
