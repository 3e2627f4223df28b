#include <gtest/gtest.h>

#include <cmath>

#include "cpp/support/expect_error.h"
#include "echopath/base/constants.h"
#include "echopath/motion/curve_motion.h"

namespace echopath::test_curve_motion {
namespace {

using test::expect_error;
using Invalid = std::invalid_argument;

constexpr double kRounding = 1e-13;
const std::vector<double> kKeys = {0.1, 0.4, 1.0};

Curve positions(CurveInterpolation interpolation) {
  Curve curve{kKeys, {0, 1, 2, 3, -1, 5, 4, 0, 1}, interpolation, {}, {}};
  if (interpolation == CurveInterpolation::kHermite) {
    curve.in_tangents = {9, 9, 9, 1, 2, 3, -1, 0, 2};
    curve.out_tangents = {2, 0, -3, 4, 1, 1, 8, 8, 8};
  }
  return curve;
}

CurveMotion moving(CurveInterpolation interpolation, const Playback& playback = {}) {
  return CurveMotion({positions(interpolation), {}, {}}, playback);
}

Vec3 place(const Motion& motion, double time) { return motion.at(time).translation(); }

void expect_near(const Vec3& value, const Vec3& wanted) {
  EXPECT_LT((value - wanted).norm(), kRounding) << value.transpose();
}

TEST(CurveMotion, StepsHoldTheEarlierKey) {
  const CurveMotion motion = moving(CurveInterpolation::kStep);
  expect_near(place(motion, 0.39), {0, 1, 2});
  expect_near(place(motion, 0.4), {3, -1, 5});
  expect_near(place(motion, 0.99), {3, -1, 5});
}

TEST(CurveMotion, GoesStraightBetweenLinearKeys) {
  expect_near(place(moving(CurveInterpolation::kLinear), 0.2), {1.0, 1.0 / 3.0, 3.0});
}

// glTF 2.0, appendix C.5:
// (2 t^3 - 3 t^2 + 1) v_k + t_d (t^3 - 2 t^2 + t) b_k + (-2 t^3 + 3 t^2) v_k+1 + t_d (t^3 - t^2) a_k+1
TEST(CurveMotion, FollowsTheCubicSplineOfTheSpecification) {
  const double t = 0.25, step = 0.6, t2 = t * t, t3 = t2 * t;
  const Vec3 from(3, -1, 5), to(4, 0, 1), leaving(4, 1, 1), arriving(-1, 0, 2);
  const Vec3 wanted = (2 * t3 - 3 * t2 + 1) * from + step * (t3 - 2 * t2 + t) * leaving + (-2 * t3 + 3 * t2) * to +
                      step * (t3 - t2) * arriving;
  expect_near(place(moving(CurveInterpolation::kHermite), 0.4 + t * step), wanted);
}

TEST(CurveMotion, HoldsTheEndsBeforeAndBehind) {
  for (const auto mode : {CurveInterpolation::kStep, CurveInterpolation::kLinear, CurveInterpolation::kHermite}) {
    const CurveMotion motion = moving(mode);
    expect_near(place(motion, -7.0), {0, 1, 2});
    expect_near(place(motion, 1.0), {4, 0, 1});
    expect_near(place(motion, 1e6), {4, 0, 1});
  }
}

TEST(CurveMotion, OffsetsAndPeriodsMoveTheClock) {
  const CurveMotion shifted = moving(CurveInterpolation::kLinear, {0.15, 0.0});
  expect_near(place(shifted, 0.05), {1.0, 1.0 / 3.0, 3.0});
  const CurveMotion looped = moving(CurveInterpolation::kLinear, {0.15, 1.0});
  for (const int run : {-3, 0, 1, 1000}) EXPECT_LT((place(looped, 0.05 + run) - Vec3(1.0, 1.0 / 3.0, 3.0)).norm(), 1e-11);
}

Curve turns(CurveInterpolation interpolation, double angle) {
  const double half = 0.5 * angle;
  Curve curve{{0.0, 2.0}, {1, 0, 0, 0, std::cos(half), 0, 0, std::sin(half)}, interpolation, {}, {}};
  if (interpolation == CurveInterpolation::kHermite) {
    curve.in_tangents = {0, 0, 0, 0, -0.1, 0, 0, 0.4};
    curve.out_tangents = {0.05, 0, 0, 0.5, 0, 0, 0, 0};
  }
  return curve;
}

double angle_at(const Motion& motion, double time) {
  const Mat3 turned = motion.at(time).linear();
  return std::atan2(turned(1, 0), turned(0, 0));
}

TEST(CurveMotion, LinearRotationsTurnAtOneRate) {
  const CurveMotion motion({{}, turns(CurveInterpolation::kLinear, 2.0), {}});
  for (const double time : {0.0, 0.3, 1.0, 1.9}) EXPECT_NEAR(angle_at(motion, time), time, kRounding);
  EXPECT_NEAR(motion.turn_rate({0.0, 2.0}), 1.0, kRounding);
}

// q and -q are one rotation: 2 pi - 1 forwards is 1 backwards.
TEST(CurveMotion, LinearRotationsGoTheShorterWay) {
  const CurveMotion motion({{}, turns(CurveInterpolation::kLinear, 2.0 * kPi - 1.0), {}});
  EXPECT_NEAR(angle_at(motion, 1.0), -0.5, kRounding);
}

// 8-bit quaternions are off by as much.
TEST(CurveMotion, KeysNearlyOfLengthOneAreScaled) {
  Curve curve = turns(CurveInterpolation::kLinear, 1.0);
  for (size_t c = 4; c < 8; ++c) curve.values[c] *= 1.007;
  const CurveMotion motion({{}, curve, {}});
  for (const double time : {0.0, 0.3, 2.0}) {
    const Mat3 wanted = Eigen::AngleAxisd(0.5 * time, Vec3::UnitZ()).toRotationMatrix();
    EXPECT_LT((motion.at(time).linear() - wanted).norm(), kRounding) << time;
  }
}

TEST(CurveMotion, RotationsOfSplinesAreNormalised) {
  const CurveMotion motion({{}, turns(CurveInterpolation::kHermite, 1.0), {}});
  const double t = 0.5, t2 = t * t, t3 = t2 * t, step = 2.0;
  const double w =
      (2 * t3 - 3 * t2 + 1) + step * (t3 - 2 * t2 + t) * 0.05 + (-2 * t3 + 3 * t2) * std::cos(0.5) + step * (t3 - t2) * -0.1;
  const double z = step * (t3 - 2 * t2 + t) * 0.5 + (-2 * t3 + 3 * t2) * std::sin(0.5) + step * (t3 - t2) * 0.4;
  EXPECT_NEAR(angle_at(motion, 1.0), 2.0 * std::atan2(z, w), kRounding);
}

TEST(CurveMotion, TurnRateBoundsTheSpeedOfSplines) {
  const CurveMotion motion({{}, turns(CurveInterpolation::kHermite, 1.0), {}});
  double fastest = 0.0;
  for (int i = 0; i < 2000; ++i) {
    fastest = std::max(fastest, std::abs(angle_at(motion, 0.001 * (i + 1)) - angle_at(motion, 0.001 * i)) / 0.001);
  }
  EXPECT_GT(motion.turn_rate({0.0, 2.0}), fastest);
  EXPECT_LT(motion.turn_rate({0.0, 2.0}), 3.0 * fastest);
}

TEST(CurveMotion, TurnRateIsThatOfGoingToAndFro) {
  std::vector<double> times, values;
  for (int i = 0; i <= 40; ++i) {
    times.push_back(0.05 * i);
    values.insert(values.end(), {0.1 * std::sin(kTwoPi * times.back()), 0.0, 0.0});
  }
  const CurveMotion motion({Curve{times, values, CurveInterpolation::kLinear, {}, {}}, {}, {}}, {0.0, 2.0});
  EXPECT_NEAR(motion.turn_rate({0.0, 2.0}), kTwoPi, 0.7);
  EXPECT_NEAR(motion.turn_rate({100.0, 102.0}), kTwoPi, 0.7);
  EXPECT_EQ(motion.turn_rate({0.30, 0.60}), 0.0);
}

TEST(CurveMotion, ScalesActBeforeTheRotation) {
  const CurveMotion motion({{}, turns(CurveInterpolation::kLinear, kPi), Curve{{0.0, 2.0}, {1, 1, 1, 3, 5, 7}}});
  const Vec3 moved = motion.at(1.0) * Vec3(1, 1, 1);  // a quarter turn about z of (2, 3, 4)
  expect_near(moved, {-3, 2, 4});
  EXPECT_FALSE(motion.is_rigid());
  EXPECT_TRUE(moving(CurveInterpolation::kStep).is_rigid());
}

TEST(CurveMotion, KeysAndEndsOfRunsAreBreakpoints) {
  EXPECT_EQ(moving(CurveInterpolation::kStep).breakpoints(), kKeys);
  Curve own = turns(CurveInterpolation::kLinear, 1.0);
  own.times = {0.3, 0.4};
  const CurveMotion both({positions(CurveInterpolation::kLinear), own, {}});
  EXPECT_EQ(both.breakpoints(), (std::vector<double>{0.1, 0.3, 0.4, 1.0}));
  const CurveMotion looped = moving(CurveInterpolation::kLinear, {0.0, 1.0});
  EXPECT_EQ(looped.breakpoints({1.0, 2.05}), (std::vector<double>{1.0, 1.1, 1.4, 2.0}));
  const CurveMotion still({Curve{{0.5}, {1, 2, 3}, CurveInterpolation::kStep, {}, {}}, {}, {}}, {0.0, 1.0});
  EXPECT_TRUE(still.breakpoints({0.0, 10.0}).empty());
}

// A frame is cut at breakpoints, so values must agree on which side of one a time lies, whatever the rounding.
TEST(CurveMotion, BreakpointsAreWhereStepsJumpToTheBit) {
  const Curve steps{{0.0, 0.1, 0.3}, {0, 0, 0, 1, 0, 0, 2, 0, 0}, CurveInterpolation::kStep, {}, {}};
  for (const double offset : {0.0, 0.123456, -7.7, 1e4 / 3}) {
    const CurveMotion motion({steps, {}, {}}, {offset, 0.7});
    int jumps = 0;
    for (const double time : motion.breakpoints({50.0, 60.0})) {
      const double before = place(motion, std::nextafter(time, 0.0)).x(), behind = place(motion, time).x();
      EXPECT_EQ(behind, before == 2.0 ? 0.0 : before + 1.0) << offset << " " << time;
      ++jumps;
    }
    EXPECT_NEAR(jumps, 43, 3);
  }
}

TEST(CurveMotion, RefusesWhatNoCurveIsBy) {
  const auto refused = [](Curve curve, const char* said) {
    expect_error<Invalid>([&] { CurveMotion({std::move(curve), {}, {}}); }, {said});
  };
  refused({{}, {}}, {"translation: must hold at least one time"});
  refused({{0, 0}, {0, 0, 0, 1, 1, 1}}, "translation: must have strictly ascending times");
  refused({{0, 1}, {0, 0, 0, 1}}, "translation: must have a row of values for each time");
  refused({{0, std::nan("")}, {0, 0, 0, 1, 1, 1}}, "translation: must have times of at most 1e9 s");
  refused({{0}, {0, 0, HUGE_VAL}}, "translation: must have finite values");
  refused({{0}, {0, 0, 0}, CurveInterpolation::kHermite, {}, {}}, "translation: must have a row of in_tangents");
  refused({{0}, {0, 0, 0}, CurveInterpolation::kHermite, {0, 0, 0}, {}}, "translation: must have a row of out_tangents");
  expect_error<Invalid>([] { CurveMotion({{}, Curve{{0}, {1, 0, 0}}, {}}); }, {"rotation: must have a row of values"});
  expect_error<Invalid>([] { CurveMotion({{}, {}, Curve{{0}, {1}}}); }, {"scale: must have a row of values"});
  expect_error<Invalid>([] { CurveMotion({{}, Curve{{0}, {2, 0, 0, 0}}, {}}); }, {"rotation: must hold unit quaternions"});
  expect_error<Invalid>([] { CurveMotion(MotionCurves{}); }, {"translation: must be given"});
  expect_error<Invalid>([] { moving(CurveInterpolation::kStep, {0.0, 1e-9}); }, {"period: must be 1e-6 to 1e9 s"});
  expect_error<Invalid>([] { moving(CurveInterpolation::kStep, {HUGE_VAL, 0.0}); }, {"offset: must be at most 1e9 s"});
  expect_error<Invalid>([] { moving(CurveInterpolation::kStep, {0.0, 1.0}).at(1e10); }, {"time: must be at most 1e9 s"});
  expect_error<Invalid>([] { moving(CurveInterpolation::kStep).at(std::nan("")); }, {"time: must be finite"});
}

}  // namespace
}  // namespace echopath::test_curve_motion
