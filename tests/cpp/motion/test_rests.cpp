#include <gtest/gtest.h>

#include <memory>

#include "echopath/motion/curve_motion.h"
#include "echopath/motion/morph_targets.h"
#include "echopath/motion/skin.h"

namespace echopath::test_rests {
namespace {

using Shapes = std::vector<std::vector<Vec3>>;

const Quaternion kTurned(0.6, 0, 0, 0.8);

TEST(Rests, OfVelocitiesTheyAreAllZero) {
  EXPECT_TRUE(LinearMotion(Vec3::Zero()).rests());
  EXPECT_FALSE(LinearMotion(Vec3(0, 0, 1e-9)).rests());
  EXPECT_FALSE(LinearMotion(Vec3::Zero(), Vec3(1e-9, 0, 0)).rests());
}

TEST(Rests, OfKeyframesTheyAreAllEqual) {
  for (const Interpolation way : {Interpolation::kCubic, Interpolation::kLinear}) {
    const KeyframeMotion motion({0, 1, 3, 4}, std::vector(4, Vec3(1, 2, 3)), std::vector(4, kTurned), way);
    EXPECT_TRUE(motion.rests());
    EXPECT_LT((motion.at(2.2).matrix() - motion.at(0.1).matrix()).norm(), 1e-15);
    EXPECT_FALSE(KeyframeMotion({0, 1}, {Vec3(1, 2, 3), Vec3(1, 2, 3.1)}, {kTurned, kTurned}, way).rests());
    EXPECT_FALSE(KeyframeMotion({0, 1}, {Vec3(1, 2, 3), Vec3(1, 2, 3)}, {kTurned, Quaternion::Identity()}, way).rests());
  }
}

TEST(Rests, OfCurvesTheyAreConstantWithTheirTangents) {
  const auto moves_by = [](Curve translation) { return !CurveMotion({std::move(translation), {}, {}}).rests(); };
  EXPECT_FALSE(moves_by({{0}, {1, 2, 3}}));
  EXPECT_FALSE(moves_by({{0, 1, 2}, {1, 2, 3, 1, 2, 3, 1, 2, 3}}));
  EXPECT_TRUE(moves_by({{0, 1, 2}, {1, 2, 3, 1, 2, 3, 1, 2, 4}}));
  const auto spline = [](double leaving) {
    return Curve{{0, 1}, {1, 2, 3, 1, 2, 3}, CurveInterpolation::kHermite, std::vector(6, 0.0), {0, leaving, 0, 0, 0, 0}};
  };
  EXPECT_FALSE(moves_by(spline(0.0)));
  EXPECT_TRUE(moves_by(spline(0.5)));
  const Curve still{{0, 1}, {1, 0, 0, 0, 1, 0, 0, 0}}, turning{{0, 1}, {1, 0, 0, 0, 0, 1, 0, 0}};
  EXPECT_TRUE(CurveMotion({{}, still, {}}).rests());
  EXPECT_FALSE(CurveMotion({{}, turning, {}}).rests());
  EXPECT_FALSE(CurveMotion({{}, still, Curve{{0, 1}, {1, 1, 1, 1, 2, 1}}}).rests());
}

TEST(Rests, OfASkinAllItsJointsAndItsShapeDo) {
  const std::vector<Vec3> vertices = {{0, 0, 0}, {1, 0, 0}};
  const auto skin = [&](double rate, double weight) {
    const Joint root{"root", -1, Transform::Identity(), nullptr, {}};
    const auto turning = std::make_shared<const LinearMotion>(Vec3::Zero(), Vec3(0, 0, rate));
    const Joint arm{"arm", 0, Transform::Identity(), turning, {}};
    const auto shape = std::make_shared<const MorphTargets>(vertices, Shapes{vertices}, Curve{{0, 1}, {0.0, weight}});
    return Skin(vertices, {root, arm}, SkinWeights{1, {0, 1}, {1.0, 1.0}}, shape);
  };
  EXPECT_TRUE(skin(0.0, 0.0).rests());
  EXPECT_FALSE(skin(1.0, 0.0).rests());
  EXPECT_FALSE(skin(0.0, 1.0).rests());
}

}  // namespace
}  // namespace echopath::test_rests
