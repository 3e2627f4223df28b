#include <gtest/gtest.h>

#include <array>

#include "echopath/base/constants.h"
#include "echopath/base/solid_angle.h"

namespace echopath::test_solid_angle {
namespace {

constexpr double kRounding = 1e-14;  // sr

const Vec3 kX = Vec3::UnitX(), kY = Vec3::UnitY(), kZ = Vec3::UnitZ();

// A triangle over the axes fills an eighth of the sphere about the origin, and its normal points away from there.
TEST(SolidAngle, IsThatOfAnOctantWithTheSignOfTheWinding) {
  EXPECT_NEAR(solid_angle({kX, kY, kZ}, Vec3::Zero()), 0.5 * kPi, kRounding);
  EXPECT_NEAR(solid_angle({kY, kX, kZ}, Vec3::Zero()), -0.5 * kPi, kRounding);
  EXPECT_LT(solid_angle({kX, kY, kZ}, Vec3(1, 1, 1)), 0.0);
}

TEST(SolidAngle, AddsUpToTheSphereWithinAClosedSurfaceAndToNothingOutside) {
  const std::array<std::array<Vec3, 3>, 4> faces = {
      {{kX, kY, kZ}, {kX, kZ, Vec3::Zero()}, {kZ, kY, Vec3::Zero()}, {kY, kX, Vec3::Zero()}}};  // normals point outward
  double within = 0.0, outside = 0.0;
  for (const std::array<Vec3, 3>& face : faces) {
    within += solid_angle(face, Vec3(0.1, 0.2, 0.3));
    outside += solid_angle(face, Vec3(0.4, 0.5, 0.6));
  }
  EXPECT_NEAR(within, 4.0 * kPi, kRounding);
  EXPECT_NEAR(outside, 0.0, kRounding);
}

}  // namespace
}  // namespace echopath::test_solid_angle
