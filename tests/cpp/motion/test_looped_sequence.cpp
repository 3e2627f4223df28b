#include <gtest/gtest.h>

#include <cmath>

#include "cpp/support/expect_error.h"
#include "echopath/base/constants.h"
#include "echopath/motion/looped_sequence.h"

namespace echopath::test_looped_sequence {
namespace {

using test::expect_error;
using Invalid = std::invalid_argument;

constexpr double kPeriod = 0.5;        // s
constexpr int kFrames = 20;            // of one run
constexpr double kSplineError = 1e-4;  // m, of a circle of 1 m through 20 points; 5/384 (2 pi / 20)^4 is 1.3e-4
constexpr double kRounding = 1e-9;     // m, of times of 1e6 s

Vec3 on_circle(double time) {
  const double angle = 2.0 * kPi * time / kPeriod;
  return {std::cos(angle), std::sin(angle), 1.0};
}

// A point that goes round in a circle, with `more` frames beyond each end of its run.
LoopedSequence circling(int more, double offset = 0.0, Interpolation interpolation = Interpolation::kCubic) {
  std::vector<double> times;
  std::vector<std::vector<Vec3>> frames;
  for (int i = -more; i <= kFrames + more; ++i) {
    times.push_back(kPeriod * i / kFrames);
    frames.push_back({on_circle(times.back())});
  }
  return LoopedSequence(times, frames, interpolation, {offset, kPeriod});
}

TEST(LoopedSequence, GoesRoundForEverAsTheClosedFormDoes) {
  const LoopedSequence sequence = circling(8, 0.07);
  for (const double time : {-3.21, 0.0, 0.43, 0.4301, 17.6, 1e6 + 0.123}) {
    EXPECT_LT((sequence.at(time)[0] - on_circle(time + 0.07)).norm(), kSplineError) << time;
    std::vector<Vec3> some;
    sequence.at(time, {0}, some);
    EXPECT_EQ(some[0], sequence.at(time)[0]);
  }
  EXPECT_LT((sequence.at(1e6 + 0.123)[0] - sequence.at(0.123)[0]).norm(), kRounding);
  EXPECT_LE(sequence.span().begin, -1e9);
  EXPECT_GE(sequence.span().end, 1e9);
}

// Splines with frames beyond their ends have the speed of the circle at the seam; those without have not.
TEST(LoopedSequence, FramesBeyondItsEndsMakeItsSeamSmooth) {
  const double step = 1e-5, speed = 2.0 * kPi / kPeriod;
  const auto jump_of_speed = [&](const LoopedSequence& sequence) {
    const auto speed_at = [&](double time) { return ((sequence.at(time + step)[0] - sequence.at(time)[0]) / step).eval(); };
    return (speed_at(kPeriod) - speed_at(kPeriod - step)).norm() / speed;
  };
  const double turn = speed * step;  // rad, by which a circle turns over a step
  EXPECT_LT(jump_of_speed(circling(8)), 1.1 * turn);
  EXPECT_GT(jump_of_speed(circling(0)), 10.0 * turn);
}

TEST(LoopedSequence, ItsBreakpointsAreTheEndsOfRunsAndTheFramesOfLines) {
  EXPECT_EQ(circling(0).breakpoints({0.2, 1.2}), (std::vector<double>{0.5, 1.0}));
  EXPECT_EQ(circling(0, 0.0, Interpolation::kLinear).breakpoints({0.9, 1.2}).size(), 13u);
  EXPECT_EQ(circling(3).knots({0.9, 1.2}).size(), 13u);
  EXPECT_NEAR(circling(4, 0.0, Interpolation::kLinear).turn_rate({0.0, 1.0}), 2.0 * kPi / kPeriod, 1e-6);
}

// Between its turns at the middle of a run and at the next run's begin lies half a period.
TEST(LoopedSequence, TurnsAtTheEndsOfRunsCount) {
  const Vec3 there = Vec3::UnitX(), here = Vec3::Zero();
  const LoopedSequence swinging({0.0, 0.25, kPeriod}, {{there}, {here}, {there}}, Interpolation::kLinear, {0.1, kPeriod});
  EXPECT_NEAR(swinging.turn_rate({0.0, 2.0}), kPi / (0.5 * kPeriod), 1e-9);
}

TEST(LoopedSequence, TimesMustHoldThePeriod) {
  const std::vector<std::vector<Vec3>> frames(2, std::vector<Vec3>(1, Vec3::Zero()));
  const auto make = [&](double begin, double end, double period) {
    return LoopedSequence({begin, end}, frames, Interpolation::kLinear, {0.0, period});
  };
  expect_error<Invalid>([&] { make(0.1, 1.0, 0.5); }, {"times", "must begin at 0 s", "0.1"});
  expect_error<Invalid>([&] { make(0.0, 1.0, 1.5); }, {"times", "must reach to the period", "1"});
  expect_error<Invalid>([&] { make(0.0, 1.0, 0.0); }, {"period", "above 0"});
  expect_error<Invalid>([&] { make(0.0, 1.0, 1.0).at(std::nan("")); }, {"time", "finite"});
}

}  // namespace
}  // namespace echopath::test_looped_sequence
