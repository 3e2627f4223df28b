// Levels of canonical targets against physical optics and the radar equation (77 GHz).
#include <gtest/gtest.h>

#include "support/scenes.h"

namespace echopath {
namespace {

using namespace testing;

constexpr double kFarRange = 2000.0;  // m: far field of a 0.2 m plate
constexpr double kPlateTolerance = 0.1;      // dB, the promise for a plate at broadside
constexpr double kMainLobeTolerance = 0.3;   // dB

double plate_dbsm(double side, double angle_deg, int64_t num_rays) {
  const double angle = angle_deg * kPi / 180.0;
  Scene scene;
  const Vec3 across(-std::sin(angle), std::cos(angle), 0.0), up = Vec3::UnitZ();
  add_rectangle(scene, "plate", Vec3(kFarRange, 0, 0) - 0.5 * side * (across + up), side * across, side * up,
                share(Material::metal()));
  TraceSettings settings;
  settings.num_rays = num_rays;
  settings.max_bounces = 1;
  const Paths paths = trace(scene, plain_radar(Vec3::Zero(), Vec3::Zero()), settings);
  return decibel(rcs_of(std::norm(coherent_sum(paths)), kFarRange, 77e9));
}

TEST(Plate, BroadsideRcsIsThatOfPhysicalOptics) {
  EXPECT_NEAR(plate_dbsm(0.05, 0.0, 1 << 16), 7.144, kPlateTolerance);
  EXPECT_NEAR(plate_dbsm(0.1, 0.0, 1 << 16), 19.185, kPlateTolerance);
  EXPECT_NEAR(plate_dbsm(0.2, 0.0, 1 << 16), 31.227, kPlateTolerance);
}

TEST(Plate, MainLobeFollowsTheSincPattern) {
  EXPECT_NEAR(plate_dbsm(0.1, 0.5, 1 << 16), 16.096, kMainLobeTolerance);
  const double main_lobe = 19.185;
  // Beyond the first null: 0.05 of the main lobe's amplitude.
  const double bound = 0.05 * std::pow(10.0, main_lobe / 20);
  for (const auto& [angle_deg, expected] : {std::pair{1.0, .277}, {2.0, -.183}, {3.0, -.980}, {5.0, -3.833}, {10.0, -21.996}, {20.0, -16.400}}) {
    EXPECT_NEAR(std::pow(10.0, plate_dbsm(0.1, angle_deg, 1 << 16) / 20), std::pow(10.0, expected / 20), bound) << angle_deg;
  }
}

}  // namespace
}  // namespace echopath
