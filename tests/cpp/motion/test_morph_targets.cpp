#include <gtest/gtest.h>

#include <cmath>

#include "cpp/support/expect_error.h"
#include "echopath/base/constants.h"
#include "echopath/motion/curve_motion.h"
#include "echopath/motion/morph_targets.h"
#include "echopath/motion/skin.h"

namespace echopath::test_morph_targets {
namespace {

using test::expect_error;
using Invalid = std::invalid_argument;

constexpr double kMorphRounding = 1e-14;
const std::vector<Vec3> kBase = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
const std::vector<std::vector<Vec3>> kTargets = {{{0, 0, 1}, {0, 0, 2}, {0, 0, 3}}, {{1, 0, 0}, {0, 0, 0}, {0, -1, 0}}};

std::shared_ptr<MorphTargets> morph(const Playback& playback = {}) {
  return std::make_shared<MorphTargets>(kBase, kTargets, Curve{{0.0, 2.0}, {0, 1, 1, 0}}, playback);
}

TEST(MorphTargets, AddSharesOfTheirTargets) {
  const std::vector<Vec3> vertices = morph()->at(0.5);  // weights 0.25 and 0.75
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_LT((vertices[i] - (kBase[i] + 0.25 * kTargets[0][i] + 0.75 * kTargets[1][i])).norm(), kMorphRounding);
  }
  std::vector<Vec3> some;
  morph()->at(0.5, {2}, some);
  EXPECT_EQ(some, std::vector<Vec3>{vertices[2]});
}

TEST(MorphTargets, FollowTheClockOfALoop) {
  EXPECT_LT((morph({0.5, 2.0})->at(10.0)[1] - morph()->at(0.5)[1]).norm(), kMorphRounding);
  EXPECT_EQ(morph({0.0, 2.0})->breakpoints({1.0, 7.0}), (std::vector<double>{2, 4, 6}));
}

TEST(MorphTargets, TurnRateIsThatOfTheirWeights) {
  const MorphTargets swinging(kBase, {kTargets[0]}, Curve{{0, 1, 2, 3, 4}, {0, 1, 0, 1, 0}});
  EXPECT_NEAR(swinging.turn_rate({0.0, 4.0}), kPi, 1e-12);
  EXPECT_EQ(swinging.turn_rate({0.1, 0.9}), 0.0);
}

TEST(MorphTargets, RefuseOtherNumbersOfVertices) {
  expect_error<Invalid>([] { MorphTargets(kBase, {{{0, 0, 1}}}, Curve{{0}, {1}}); },
                        {"targets: must have a displacement for each vertex"});
  expect_error<Invalid>([] { MorphTargets(kBase, {}, Curve{{0}, {1}}); }, {"targets: must hold at least one target"});
  expect_error<Invalid>([] { MorphTargets(kBase, kTargets, Curve{{0}, {1}}); }, {"weights: must have a row of values"});
  const std::vector<Vec3> nowhere(kBase.size(), Vec3(0, std::nan(""), 0));
  expect_error<Invalid>([&] { MorphTargets(nowhere, kTargets, Curve{{0}, {1, 1}}); }, {"vertices: must be finite"});
  expect_error<Invalid>([&] { MorphTargets(kBase, {nowhere}, Curve{{0}, {1}}); }, {"targets: must be finite"});
  expect_error<Invalid>([] { morph({0.0, -1.0}); }, {"period: must be 1e-6 to 1e9 s"});
  expect_error<Invalid>([] { MorphTargets({}, kTargets, Curve{{0}, {1, 1}}); }, {"vertices: must hold at least one vertex"});
}

// The joint turns by 90 degrees about z and moves by (0, 0, 5): (x, y, z) -> (-y, x, z + 5).
TEST(SkinShape, IsTakenBeforeTheJointsMove) {
  Joint joint;
  joint.name = "arm";
  const double half = std::sqrt(0.5);
  joint.motion =
      std::make_shared<CurveMotion>(MotionCurves{Curve{{0}, {0, 0, 5}}, Curve{{0}, {half, 0, 0, half}}, std::nullopt});
  const SkinWeights weights{1, {0, 0, 0}, {1, 1, 1}};
  const Skin skin(kBase, {joint}, weights, morph());
  const std::vector<Vec3> vertices = skin.at(0.5), shaped = morph()->at(0.5);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_LT((vertices[i] - Vec3(-shaped[i].y(), shaped[i].x(), shaped[i].z() + 5.0)).norm(), kMorphRounding * 10);
  }
  std::vector<Vec3> some;
  skin.at(0.5, {1, 2}, some);
  EXPECT_EQ(some, (std::vector<Vec3>{vertices[1], vertices[2]}));
  EXPECT_EQ(skin.breakpoints(), (std::vector<double>{0.0, 2.0}));
  expect_error<Invalid>([&] { Skin({{0, 0, 0}}, {joint}, {1, {0}, {1}}, morph()); }, {"shape: must have as many vertices"});
  expect_error<Invalid>([&] { Skin(kBase, {joint}, weights, std::make_shared<Skin>(kBase, std::vector{joint}, weights)); },
                        {"shape: must not be a skin itself"});
}

}  // namespace
}  // namespace echopath::test_morph_targets
