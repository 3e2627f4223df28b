#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "echopath/base/constants.h"
#include "echopath/motion/curve_motion.h"
#include "echopath/motion/deformation.h"
#include "echopath/motion/morph_targets.h"
#include "echopath/motion/skin.h"

namespace echopath::test_turn_rate {
namespace {

constexpr double kRounding = 1e-12;

// What has these heights turns at 1, 2, 3, 3.5 and 5 s.
const std::vector<double> kTimes = {0, 1, 2, 3, 3.5, 5, 6};
const std::vector<double> kHeights = {0, 1, 0, 1, 0, 1, 0};

Quaternion about_z(double angle) { return Quaternion(Eigen::AngleAxisd(angle, Vec3::UnitZ())); }

std::vector<double> key_of(double angle) { return {std::cos(0.5 * angle), 0, 0, std::sin(0.5 * angle)}; }

Curve turned_by(const std::vector<double>& times, const std::vector<double>& angles, CurveInterpolation interpolation) {
  Curve curve{times, {}, interpolation, {}, {}};
  for (const double angle : angles) {
    const std::vector<double> key = key_of(angle);
    curve.values.insert(curve.values.end(), key.begin(), key.end());
  }
  return curve;
}

// Curve with columns of 0 but for one, which has `heights`.
Curve columns_at_rest_but(int moving, int num_columns, const std::vector<double>& heights) {
  Curve curve{kTimes, std::vector<double>(heights.size() * num_columns), CurveInterpolation::kLinear, {}, {}};
  for (size_t k = 0; k < heights.size(); ++k) curve.values[k * num_columns + moving] = heights[k];
  return curve;
}

double fastest_turn(const Motion& motion, double end) {
  constexpr double kStep = 1e-3;
  double fastest = 0.0;
  for (double time = 0.0; time + kStep <= end; time += kStep) {
    const Quaternion from(motion.at(time).linear()), to(motion.at(time + kStep).linear());
    fastest = std::max(fastest, from.angularDistance(to) / kStep);
  }
  return fastest;
}

TEST(TurnRate, OfKeysIsPiOverTheShortestTimeBetweenTurns) {
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<Vec3> places(kTimes.size(), Vec3::Zero());
    for (size_t k = 0; k < places.size(); ++k) places[k][axis] = kHeights[k];
    const KeyframeMotion motion(kTimes, places, {});
    EXPECT_NEAR(motion.turn_rate({0.0, 6.0}), kPi / 0.5, kRounding);
    EXPECT_NEAR(motion.turn_rate({0.0, 2.9}), kPi, kRounding);
    EXPECT_EQ(motion.turn_rate({0.1, 1.9}), 0.0);
    for (Vec3& place : places) place *= 1e-10;  // less than rounding
    EXPECT_EQ(KeyframeMotion(kTimes, places, {}).turn_rate({0.0, 6.0}), 0.0);
  }
}

TEST(TurnRate, OfLinearRotationsIsTheirSpeed) {
  const KeyframeMotion motion({0, 1, 1.5}, std::vector(3, Vec3(1, 2, 3)), {about_z(0), about_z(0.5), about_z(1.5)},
                              Interpolation::kLinear);
  EXPECT_NEAR(motion.turn_rate({0.1, 0.9}), 0.5, kRounding);
  EXPECT_NEAR(motion.turn_rate({0.1, 1.1}), 2.0, kRounding);
}

TEST(TurnRate, OfSplinesOfRotationsBoundsTheirSpeed) {
  const KeyframeMotion motion({0, 0.5, 1.5, 2}, {}, {about_z(0), about_z(1.5), about_z(1.2), about_z(2.5)});
  const double fastest = fastest_turn(motion, 2.0);
  EXPECT_GT(motion.turn_rate({0.0, 2.0}), fastest);
  EXPECT_LT(motion.turn_rate({0.0, 2.0}), 3.0 * fastest);
}

TEST(TurnRate, OfVertexSequencesIsThatOfTheirQuickestVertex) {
  std::vector<std::vector<Vec3>> frames;
  for (const double height : kHeights) frames.push_back({Vec3(0, 0, 1), Vec3(0, height, 0), Vec3(1, 0, 0)});
  const VertexSequence sequence(kTimes, frames);
  EXPECT_NEAR(sequence.turn_rate({0.0, 6.0}), kPi / 0.5, kRounding);
  EXPECT_NEAR(sequence.turn_rate({0.5, 2.5}), kPi, kRounding);
  EXPECT_EQ(sequence.turn_rate({0.5, 1.5}), 0.0);
}

TEST(TurnRate, OfMorphTargetsIsThatOfAnyWeight) {
  const std::vector<Vec3> vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, target = {{0, 0, 0}, {0, 0, 1e-3}, {0, 0, 0}};
  const std::vector<std::vector<Vec3>> targets(5, target);
  for (int moving = 0; moving < 5; ++moving) {
    const MorphTargets morph(vertices, targets, columns_at_rest_but(moving, 5, kHeights));
    EXPECT_NEAR(morph.turn_rate({0.0, 6.0}), kPi / 0.5, kRounding) << moving;
  }
  const std::vector<double> faint = {0, 1e-7, 0, 1e-7, 0, 1e-7, 0};  // times a millimetre: rounding
  EXPECT_EQ(MorphTargets(vertices, targets, columns_at_rest_but(0, 5, faint)).turn_rate({0.0, 6.0}), 0.0);
}

TEST(TurnRate, OfScalesCounts) {
  const CurveMotion motion({{}, {}, columns_at_rest_but(1, 3, kHeights)});
  EXPECT_NEAR(motion.turn_rate({0.0, 6.0}), kPi / 0.5, kRounding);
}

// The arm goes up and down between two keys of one height: s (1 - s) (1 - 2 s) turns at s = (1 -+ sqrt(1 / 3)) / 2.
TEST(TurnRate, OfHermiteSplinesSeesTurnsBetweenTheirKeys) {
  Curve curve{{0, 2}, std::vector(6, 0.0), CurveInterpolation::kHermite, std::vector(6, 0.0), std::vector(6, 0.0)};
  curve.out_tangents[2] = curve.in_tangents[5] = 1.0;
  const double turned = 2.0 * std::sqrt(1.0 / 3.0);  // s between the turns
  const double rate = CurveMotion({curve, {}, {}}).turn_rate({0.0, 2.0});
  EXPECT_GT(rate, kPi / turned);
  EXPECT_LT(rate, 1.3 * kPi / turned);
}

// A spline whose tangents are its chord is the chord, and turns by the fastest where it is nearest to 0.
TEST(TurnRate, OfASplineAlongItsChordIsThatInTheMiddle) {
  const double step = 0.5, half = 75.0 * kPi / 180.0;
  Curve curve = turned_by({0, step}, {0.0, 2.0 * half}, CurveInterpolation::kHermite);
  for (int c = 0; c < 8; ++c) curve.in_tangents.push_back((curve.values[4 + c % 4] - curve.values[c % 4]) / step);
  curve.out_tangents = curve.in_tangents;
  // The chord is 2 sin(half / 2) long and cos(half / 2) from 0; rotations turn by twice the angle of their quaternions.
  const double wanted = 2.0 * 2.0 * std::tan(0.5 * half) / step;
  EXPECT_NEAR(CurveMotion({{}, curve, {}}).turn_rate({0.0, step}), wanted, 1e-9);
}

TEST(TurnRate, OfStepsIsNone) {
  EXPECT_EQ(CurveMotion({{}, turned_by({0, 1}, {0, 1}, CurveInterpolation::kStep), {}}).turn_rate({0.0, 1.0}), 0.0);
}

TEST(TurnRate, IsThatOfTheKeysThatArePlayed) {
  const Curve curve = turned_by({0, 1, 2}, {0.0, 2.0, 2.5}, CurveInterpolation::kLinear);
  const CurveMotion shifted({{}, curve, {}}, {1.0, 0.0}), looped({{}, curve, {}}, {0.0, 2.0});
  EXPECT_NEAR(shifted.turn_rate({0.1, 0.9}), 0.5, kRounding);
  EXPECT_NEAR(shifted.turn_rate({-0.9, -0.1}), 2.0, kRounding);
  EXPECT_NEAR(looped.turn_rate({100.0, 102.0}), 2.0, kRounding);
}

TEST(TurnRate, OfASkinAddsUpAlongItsJoints) {
  const auto joint = [](const char* name, int parent, double rate) {
    const auto motion = std::make_shared<const LinearMotion>(Vec3::Zero(), Vec3(0, 0, rate));
    return Joint{name, parent, Transform::Identity(), motion, {}};
  };
  const std::vector<Vec3> vertices = {{0, 0, 0}, {1, 0, 0}};
  std::vector<Joint> joints = {joint("trunk", -1, 1.0), joint("leg", 0, 4.0), joint("arm", 0, -2.0), joint("hand", 2, 2.5)};
  joints.push_back({"cap", 0, Transform::Identity(), nullptr, {}});
  const SkinWeights weights{1, {0, 1}, {1.0, 1.0}};
  EXPECT_NEAR(Skin(vertices, joints, weights).turn_rate({0.0, 1.0}), 5.5, kRounding);
  const auto shape = std::make_shared<const MorphTargets>(vertices, std::vector<std::vector<Vec3>>{vertices},
                                                          columns_at_rest_but(0, 1, kHeights));
  EXPECT_NEAR(Skin(vertices, joints, weights, shape).turn_rate({0.0, 6.0}), 5.5 + kPi / 0.5, kRounding);
}

}  // namespace
}  // namespace echopath::test_turn_rate
