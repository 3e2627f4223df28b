#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cpp/support/expect_error.h"
#include "echopath/motion/motion.h"

namespace echopath::test_keyframe_motion {
namespace {

using test::expect_error;
using Invalid = std::invalid_argument;

constexpr double kRounding = 1e-12;  // of splines through values of order 10

// Unequal steps: equal ones would hide a mix-up of neighbouring intervals.
const std::vector<double> kTimes = {-0.5, -0.1, 0.0, 0.3, 0.35, 0.9, 1.4, 1.5};

Vec3 cubic(double t) { return {1.0 - 2.0 * t + 3.0 * t * t - 4.0 * t * t * t, t * t * t, 7.0 + t * t}; }
Vec3 parabola(double t) { return {1.0 - 2.0 * t + 3.0 * t * t, t * t, -t}; }
Vec3 line(double t) { return {4.0 - 3.0 * t, t, 1.0}; }

std::vector<Vec3> sampled(Vec3 (*curve)(double), const std::vector<double>& times) {
  std::vector<Vec3> values;
  for (const double time : times) values.push_back(curve(time));
  return values;
}

double worst_error(const KeyframeMotion& motion, Vec3 (*curve)(double)) {
  double worst = 0.0;
  const TimeSpan span = motion.span();
  for (int i = 0; i <= 1000; ++i) {
    const double time = span.begin + (span.end - span.begin) * i / 1000.0;
    worst = std::max(worst, (motion.at(time).translation() - curve(time)).norm());
  }
  return worst;
}

Quaternion about(const Vec3& axis, double angle) { return Quaternion(Eigen::AngleAxisd(angle, axis.normalized())); }

TEST(KeyframeMotion, SplinesReproduceCubics) {
  EXPECT_LT(worst_error(KeyframeMotion(kTimes, sampled(cubic, kTimes), {}), cubic), kRounding);
}

TEST(KeyframeMotion, SplinesThroughFourKeysAreTheirCubic) {
  const std::vector<double> times = {0.0, 0.2, 0.9, 1.0};
  EXPECT_LT(worst_error(KeyframeMotion(times, sampled(cubic, times), {}), cubic), kRounding);
}

TEST(KeyframeMotion, SplinesThroughThreeKeysAreTheirParabola) {
  const std::vector<double> times = {0.0, 0.2, 1.0};
  EXPECT_LT(worst_error(KeyframeMotion(times, sampled(parabola, times), {}), parabola), kRounding);
}

TEST(KeyframeMotion, SplinesThroughTwoKeysAreTheirLine) {
  const std::vector<double> times = {0.0, 0.2};
  EXPECT_LT(worst_error(KeyframeMotion(times, sampled(line, times), {}), line), kRounding);
}

// A parabola from 0 to 0 over `kRest`, whose slope at the end is no steeper than what follows, is no higher than a quarter
// of their product.
TEST(KeyframeMotion, ALongRestBeforeOrBehindAWaySwingsNoFartherThanAParabola) {
  constexpr double kRest = 10.0, kSpeed = 1.4;
  std::vector<double> times = {0.0};
  std::vector<Vec3> places = {Vec3::Zero()};
  for (int i = 0; i < 5; ++i) {
    times.push_back(kRest + 0.1 * i);
    places.emplace_back(0.1 * kSpeed * i, 0.0, 0.0);
  }
  for (const bool is_behind : {false, true}) {
    if (is_behind) {
      std::ranges::reverse(times), std::ranges::reverse(places);
      for (double& time : times) time = kRest + 0.4 - time;
    }
    const KeyframeMotion motion(times, places, {});
    for (int i = 0; i <= 100; ++i) {
      const double time = (is_behind ? 0.4 : 0.0) + 0.01 * kRest * i;
      EXPECT_LE(std::abs(motion.at(time).translation().x()), 0.25 * kSpeed * kRest) << time;
    }
  }
}

TEST(KeyframeMotion, SplinesPassThroughTheirKeys) {
  std::vector<Vec3> values;
  for (const double time : kTimes) values.push_back(Vec3(std::cos(9.0 * time), std::sin(50.0 * time), time * time));
  const KeyframeMotion motion(kTimes, values, {});
  for (size_t i = 0; i < kTimes.size(); ++i) {
    EXPECT_LT((motion.at(kTimes[i]).translation() - values[i]).norm(), kRounding);
  }
}

// Velocity and acceleration do not jump at a key. Differences of step d see a jump as it is and a smooth curve as d
// times its next derivative, so halving the step must halve what they see.
TEST(KeyframeMotion, SplinesAreTwiceContinuouslyDifferentiable) {
  std::vector<Vec3> values;
  for (const double time : kTimes) values.push_back(Vec3(std::cos(9.0 * time), 0, 0));
  const KeyframeMotion motion(kTimes, values, {});
  const auto x = [&](double t) { return motion.at(t).translation().x(); };
  const auto acceleration_jump = [&](double t, double d) {
    const double after = (x(t) - 2.0 * x(t + d) + x(t + 2 * d)) / (d * d);
    const double before = (x(t) - 2.0 * x(t - d) + x(t - 2 * d)) / (d * d);
    return std::abs(after - before);
  };
  for (size_t i = 1; i + 1 < kTimes.size(); ++i) {
    const double coarse = acceleration_jump(kTimes[i], 2e-3), fine = acceleration_jump(kTimes[i], 1e-3);
    EXPECT_NEAR(fine / coarse, 0.5, 1e-4) << "key " << i;  // rounding over d^2 is 1e-9 of the acceleration
  }
}

TEST(KeyframeMotion, SplinesConvergeWithTheFourthPowerOfTheStep) {
  const auto error_of = [](int num_keys) {
    std::vector<double> times;
    std::vector<Vec3> values;
    for (int i = 0; i < num_keys; ++i) {
      times.push_back(static_cast<double>(i) / (num_keys - 1));
      values.push_back(Vec3(std::sin(6.0 * times.back()), 0, 0));
    }
    return worst_error(KeyframeMotion(times, values, {}), [](double t) { return Vec3(std::sin(6.0 * t), 0, 0); });
  };
  EXPECT_NEAR(std::log2(error_of(41) / error_of(81)), 4.0, 0.3);  // the ends converge a little faster at first
}

TEST(KeyframeMotion, LinearIsStraightBetweenKeysWithABreakpointAtEach) {
  const KeyframeMotion motion({0, 1, 3}, {Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(2, 4, 0)}, {}, Interpolation::kLinear);
  EXPECT_EQ(motion.at(0.25).translation(), Vec3(0.5, 0, 0));
  EXPECT_EQ(motion.at(2.5).translation(), Vec3(2, 3, 0));
  EXPECT_EQ(motion.breakpoints(), std::vector<double>{1.0});
  EXPECT_TRUE(KeyframeMotion({0, 1, 3}, {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}, {}).breakpoints().empty());
}

// slerp(q0, q1, t) = (q0 sin((1-t) w) + q1 sin(t w)) / sin w, cos w = q0.q1 (Shoemake 1985).
TEST(KeyframeMotion, LinearRotationsFollowTheClosedFormOfSlerp) {
  const Quaternion first = about(Vec3(1, 2, 3), 0.4), second = about(Vec3(-1, 0.5, 2), 1.9);
  const KeyframeMotion motion({0, 2}, {}, {first, second}, Interpolation::kLinear);
  const double omega = std::acos(first.coeffs().dot(second.coeffs()));
  for (const double t : {0.0, 0.1, 0.5, 0.83, 1.0}) {
    const Eigen::Vector4d expected =
        (first.coeffs() * std::sin((1 - t) * omega) + second.coeffs() * std::sin(t * omega)) / std::sin(omega);
    const Mat3 difference = motion.at(2.0 * t).linear() - Quaternion(expected).toRotationMatrix();
    EXPECT_LT(difference.norm(), kRounding);
  }
}

TEST(KeyframeMotion, TheSignOfAQuaternionDoesNotMatter) {
  for (const Interpolation interpolation : {Interpolation::kCubic, Interpolation::kLinear, Interpolation::kMonotone}) {
    std::vector<Quaternion> plain, flipped;
    for (size_t i = 0; i < kTimes.size(); ++i) {
      plain.push_back(about(Vec3(0, 1, 1), 0.8 * static_cast<double>(i)));
      flipped.push_back(plain.back());
      if (i % 3 == 1) flipped.back().coeffs() *= -1.0;
    }
    const KeyframeMotion one(kTimes, {}, plain, interpolation), other(kTimes, {}, flipped, interpolation);
    for (const double time : {-0.3, 0.01, 0.32, 1.2}) EXPECT_EQ(one.at(time).matrix(), other.at(time).matrix());
  }
}

TEST(KeyframeMotion, QuaternionsNearlyOfLengthOneAreScaledOnce) {
  std::vector<Quaternion> rotations;
  for (size_t i = 0; i < kTimes.size(); ++i) {
    rotations.push_back(about(Vec3(1, 2, 3), 0.2 * static_cast<double>(i)));
    rotations.back().coeffs() *= 1.0 + 9e-7;
  }
  const std::vector<Quaternion> once = KeyframeMotion(kTimes, {}, rotations).rotations();
  const std::vector<Quaternion> twice = KeyframeMotion(kTimes, {}, once).rotations();
  for (size_t i = 0; i < once.size(); ++i) {
    EXPECT_NEAR(once[i].norm(), 1.0, kRounding);
    EXPECT_EQ(twice[i].coeffs(), once[i].coeffs());
  }
}

TEST(KeyframeMotion, CubicRotationsStayRotationsAndFollowASteadyTurn) {
  std::vector<double> times;
  std::vector<Quaternion> rotations;
  for (int i = 0; i <= 20; ++i) {
    times.push_back(0.1 * i);
    rotations.push_back(about(Vec3::UnitZ(), 3.0 * times.back()));
  }
  const KeyframeMotion motion(times, {}, rotations);
  for (int i = 0; i <= 400; ++i) {
    const double time = 0.005 * i;
    const Mat3 turn = motion.at(time).linear();
    EXPECT_LT((turn * turn.transpose() - Mat3::Identity()).norm(), kRounding);
    const Mat3 expected = Eigen::AngleAxisd(3.0 * time, Vec3::UnitZ()).toRotationMatrix();
    EXPECT_LT((turn - expected).norm(), 2e-5);  // (w h / 2)^4 / 384 of a sampled turn, and the ends
  }
}

TEST(KeyframeMotion, WhatIsNotGivenStaysAtRest) {
  const Quaternion turn = about(Vec3::UnitX(), 1.0);
  EXPECT_EQ(KeyframeMotion({0, 1}, {}, {turn, turn}).at(0.5).translation(), Vec3::Zero());
  EXPECT_EQ(KeyframeMotion({0, 1}, {Vec3::Zero(), Vec3::UnitX()}, {}).at(0.5).linear(), Mat3::Identity());
}

TEST(KeyframeMotion, ForgivesTheRoundingOfATimeAndNothingMore) {
  const KeyframeMotion motion({0.0, 0.3}, {Vec3::Zero(), Vec3::UnitX()}, {});
  EXPECT_EQ(motion.at(0.1 + 0.2).translation(), Vec3::UnitX());  // 0.30000000000000004
  expect_error<Invalid>([&] { motion.at(0.3 + 1e-9); }, {"time", "[0, 0.2999", "0.300000001"});
  expect_error<Invalid>([&] { motion.at(-1e-9); }, {"time"});
  expect_error<Invalid>([&] { motion.at(std::numeric_limits<double>::quiet_NaN()); }, {"time", "nan"});
}

TEST(KeyframeMotion, RefusesBadInputByName) {
  const std::vector<Vec3> two = {Vec3::Zero(), Vec3::UnitX()};
  const Quaternion identity = Quaternion::Identity(), too_long(1.001, 0, 0, 0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_error<Invalid>([&] { KeyframeMotion({0}, {Vec3::Zero()}, {}); }, {"times", "at least 2"});
  expect_error<Invalid>([&] { KeyframeMotion({0, 0}, two, {}); }, {"times", "ascending"});
  expect_error<Invalid>([&] { KeyframeMotion({1, 0}, two, {}); }, {"times", "ascending"});
  expect_error<Invalid>([&] { KeyframeMotion({0, nan}, two, {}); }, {"times", "finite"});
  expect_error<Invalid>([&] { KeyframeMotion({0, 1, 2}, two, {}); }, {"translations", "got 2"});
  expect_error<Invalid>([&] { KeyframeMotion({0, 1}, {Vec3::Zero(), Vec3(nan, 0, 0)}, {}); }, {"translations", "finite"});
  expect_error<Invalid>([&] { KeyframeMotion({0, 1}, {}, {identity}); }, {"rotations", "got 1"});
  expect_error<Invalid>([&] { KeyframeMotion({0, 1}, {}, {identity, too_long}); }, {"rotations", "unit", "got 1.001"});
  expect_error<Invalid>([&] { KeyframeMotion({0, 1}, {}, {}); }, {"translations"});
}

}  // namespace
}  // namespace echopath::test_keyframe_motion
