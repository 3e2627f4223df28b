#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <stdexcept>

#include "echopath/motion/curve_motion.h"
#include "echopath/motion/deformation.h"
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
  for (const Interpolation way : {Interpolation::kCubic, Interpolation::kLinear, Interpolation::kMonotone}) {
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
  Curve opposite{{0, 1}, {0.6, 0, 0.8, 0, -0.6, 0, -0.8, 0}};  // quaternions of one rotation
  EXPECT_TRUE(CurveMotion({{}, opposite, {}}).rests());
  opposite.interpolation = CurveInterpolation::kHermite;  // whose way leads through others
  opposite.in_tangents = opposite.out_tangents = std::vector(8, 0.0);
  EXPECT_FALSE(CurveMotion({{}, opposite, {}}).rests());
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

TEST(Rests, OfVertexSequencesTheirFramesAreAllEqual) {
  const std::vector<Vec3> there = {{0.1, 0.2, 0.3}, {1, 0, 0.7}};
  std::vector<Vec3> elsewhere = there;
  elsewhere[1].z() += 1e-9;
  EXPECT_TRUE(VertexSequence({0, 1, 3}, {there, there, there}).rests());
  EXPECT_FALSE(VertexSequence({0, 1, 3}, {there, there, elsewhere}).rests());
}

// Frames are the same alone and in a row, to the last bit, though sums of equal keys round differently from time to time.
TEST(Rests, AreAtTheSamePlaceToTheLastBit) {
  const Vec3 place(0.1, -0.7, 1.3);
  const Quaternion turned = Quaternion(0.3, 0.5, -0.2, 0.7).normalized();
  const auto curve = [](const auto& columns, CurveInterpolation way) {
    const std::vector<double> one(columns.data(), columns.data() + columns.size());
    Curve made{{0.0, 0.3, 0.7}, {}, way};
    for (int k = 0; k < 3; ++k) made.values.insert(made.values.end(), one.begin(), one.end());
    if (way == CurveInterpolation::kHermite) made.in_tangents = made.out_tangents = std::vector(made.values.size(), 0.0);
    return made;
  };
  std::vector<std::unique_ptr<const Motion>> motions;
  for (const Interpolation way : {Interpolation::kCubic, Interpolation::kLinear, Interpolation::kMonotone}) {
    motions.push_back(std::make_unique<KeyframeMotion>(std::vector{0.0, 0.3, 0.4, 0.7}, std::vector(4, place),
                                                       std::vector(4, turned), way));
  }
  const Eigen::Vector4d rotation(turned.w(), turned.x(), turned.y(), turned.z());
  for (const CurveInterpolation way : {CurveInterpolation::kLinear, CurveInterpolation::kHermite}) {
    for (const double period : {0.0, 0.7}) {
      const MotionCurves curves{curve(place, way), curve(rotation, way), curve(place, way)};
      motions.push_back(std::make_unique<CurveMotion>(curves, Playback{0.1, period}));
    }
  }
  const std::vector<Vec3> vertices = {place, 3 * place};
  const VertexSequence sequence({0.0, 0.3, 0.4, 0.7}, std::vector(4, vertices));
  const MorphTargets morphs(vertices, Shapes{vertices}, curve(Eigen::Vector<double, 1>(0.3), CurveInterpolation::kLinear));
  for (double time = 0.0; time <= 0.7; time += 0.013) {
    for (const auto& motion : motions) EXPECT_EQ(motion->at(time).matrix(), motion->at(0.0).matrix()) << time;
    EXPECT_EQ(sequence.at(time), sequence.at(0.0)) << time;
    EXPECT_EQ(morphs.at(time), morphs.at(0.0)) << time;
  }
  EXPECT_THROW(motions[2]->at(NAN), std::invalid_argument);
}

}  // namespace
}  // namespace echopath::test_rests
