#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "echopath/base/constants.h"
#include "echopath/motion/deformation.h"
#include "echopath/motion/motion.h"

namespace echopath::test_monotone_motion {
namespace {

constexpr double kRounding = 1e-12;   // of values of order 10
constexpr double kDifference = 1e-6;  // s, of two times whose difference tells a velocity

Quaternion about_up(double angle) { return Quaternion(Eigen::AngleAxisd(angle, Vec3::UnitZ())); }

KeyframeMotion through(const std::vector<double>& times, const std::vector<Vec3>& places) {
  return KeyframeMotion(times, places, {}, Interpolation::kMonotone);
}

Vec3 place(const Motion& motion, double time) { return motion.at(time).translation(); }

Vec3 velocity(const Motion& motion, double begin, double step = kDifference) {
  return (place(motion, begin + step) - place(motion, begin)) / step;
}

// Velocities by hand: 9 / (5 / 1 + 4 / 2) at the inner key, and those of the parabolas through three keys at the ends.
TEST(MonotoneMotion, VelocitiesAtKeysAreTheHarmonicMeansOfFritschAndButland) {
  const Vec3 way(0.6, 0.0, 0.8);
  const KeyframeMotion motion = through({0, 1, 3}, {0 * way, 1 * way, 5 * way});
  const double begin = 2.0 / 3.0, middle = 9.0 / 7.0, end = 8.0 / 3.0;
  EXPECT_NEAR(place(motion, 0.5).dot(way), 0.5 + (begin - middle) / 8.0, kRounding);
  EXPECT_NEAR(place(motion, 2.0).dot(way), 3.0 + 2.0 * (middle - end) / 8.0, kRounding);
  EXPECT_NEAR(velocity(motion, 1.0 - kDifference).dot(way), middle, 1e-5);
  EXPECT_NEAR(velocity(motion, 1.0).dot(way), middle, 1e-5);
  EXPECT_EQ(motion.breakpoints(), std::vector<double>{1.0});
}

TEST(MonotoneMotion, TwoKeysAreTheirLine) {
  EXPECT_LT((place(through({0, 2}, {Vec3(1, 2, 3), Vec3(3, 2, 1)}), 0.5) - Vec3(1.5, 2, 2.5)).norm(), kRounding);
}

TEST(MonotoneMotion, LinesAtOneSpeedAreReproduced) {
  const std::vector<double> times = {-0.5, -0.1, 0.0, 0.3, 0.35, 0.9};
  std::vector<Vec3> places;
  for (const double time : times) places.push_back(Vec3(4.0 - 3.0 * time, time, 1.0));
  for (double time = -0.5; time < 0.9; time += 0.01) {
    EXPECT_LT((place(through(times, places), time) - Vec3(4.0 - 3.0 * time, time, 1.0)).norm(), kRounding);
  }
}

TEST(MonotoneMotion, WhatRestsBetweenKeysRestsThereWhateverComesBeforeAndBehind) {
  const Vec3 stop(10, -2, 0.5);
  const KeyframeMotion motion =
      through({0, 1, 1.1, 9, 9.1, 10}, {Vec3(0, -2, 0.5), Vec3(9, -2, 0.5), stop, stop, stop, Vec3(10, 5, 0.5)});
  for (double time = 1.1; time < 9.1; time += 0.01) EXPECT_LT((place(motion, time) - stop).norm(), 1e-14) << time;
  EXPECT_LT(velocity(motion, 1.1 - kDifference).norm(), 1e-3);  // 100 m/s on average in the last step before
}

TEST(MonotoneMotion, NoPointOfALineIsOutsideItsTwoKeysAndNoneGoesBack) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> step(0.01, 1.0), rise(-1.0, 1.0);
  const Vec3 way = Vec3(1.0, -2.0, 0.5).normalized();
  for (int i = 0; i < 200; ++i) {
    std::vector<double> times = {0.0}, ways = {0.0};
    std::vector<Vec3> places = {Vec3::Zero()};
    for (int k = 0; k < 6; ++k) {
      const double change = rise(random);
      times.push_back(times.back() + step(random));
      ways.push_back(ways.back() + (std::abs(change) < 0.3 ? 0.0 : change));
      places.push_back(ways.back() * way);
    }
    const KeyframeMotion motion = through(times, places);
    for (size_t k = 0; k + 1 < times.size(); ++k) {
      const double direction = ways[k + 1] < ways[k] ? -1.0 : 1.0;
      double before = direction * ways[k];
      for (int j = 1; j <= 50; ++j) {
        const double now = direction * place(motion, times[k] + j / 50.0 * (times[k + 1] - times[k])).dot(way);
        EXPECT_GE(now, before - kRounding);
        before = now;
      }
      EXPECT_LE(before, direction * ways[k + 1] + kRounding);
    }
  }
}

TEST(MonotoneMotion, VelocitiesTurnHalfwayWhereTheWayBends) {
  const KeyframeMotion motion = through({0, 1, 2}, {Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(2, 2, 0)});
  EXPECT_LT((velocity(motion, 1.0) - Vec3(1, 1, 0)).norm(), 1e-4);
  EXPECT_LT((velocity(motion, 1.0 - kDifference) - Vec3(1, 1, 0)).norm(), 1e-4);
}

TEST(MonotoneMotion, TurnedKeysGiveTheTurnedMotion) {
  const std::vector<double> times = {0, 0.4, 1.0, 1.1, 2.0};
  const std::vector<Vec3> places = {Vec3(0, 0, 1), Vec3(2, 1, 0), Vec3(2, 1, 0), Vec3(3, -1, 1), Vec3(0, 4, 0)};
  const Quaternion turn(Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()));
  std::vector<Quaternion> rotations, turned_rotations;
  std::vector<Vec3> turned_places;
  for (size_t k = 0; k < times.size(); ++k) {
    rotations.push_back(about_up(0.5 * static_cast<double>(k * k)) * Quaternion(Eigen::AngleAxisd(0.3, Vec3::UnitX())));
    turned_rotations.push_back(turn * rotations.back());
    turned_places.push_back(turn * places[k]);
  }
  const KeyframeMotion motion(times, places, rotations, Interpolation::kMonotone);
  const KeyframeMotion turned(times, turned_places, turned_rotations, Interpolation::kMonotone);
  for (double time = 0.0; time < 2.0; time += 0.03) {
    EXPECT_LT(((turn * motion.at(time)).matrix() - turned.at(time).matrix()).norm(), kRounding);
  }
}

TEST(MonotoneMotion, WhatStopsTurningDoesNotSwing) {
  const double quarter = 0.5 * kPi;
  const KeyframeMotion motion(
      {0, 1, 1.2, 5, 6}, {},
      {about_up(0), about_up(quarter), about_up(1.2 * quarter), about_up(1.2 * quarter), about_up(1.2 * quarter)},
      Interpolation::kMonotone);
  double before = 0.0;
  for (double time = 0.0; time < 6.0; time += 0.01) {
    const Mat3 at = motion.at(time).linear();
    const double angle = std::atan2(at(1, 0), at(0, 0));
    EXPECT_GE(angle, before - kRounding);
    EXPECT_LE(angle, 1.2 * quarter + kRounding);
    before = angle;
  }
}

TEST(MonotoneMotion, TurnRatesBoundWhatTurns) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> step(0.05, 1.0);
  for (int i = 0; i < 100; ++i) {
    std::vector<double> times = {0.0};
    std::vector<Quaternion> rotations;
    for (int k = 0; k < 5; ++k) {
      rotations.push_back(Quaternion(normal(random), normal(random), normal(random), normal(random)).normalized());
      if (k > 0) times.push_back(times.back() + step(random));
    }
    const KeyframeMotion motion(times, {}, rotations, Interpolation::kMonotone);
    for (size_t k = 0; k + 1 < times.size(); ++k) {
      const double width = (times[k + 1] - times[k]) / 200.0;
      double fastest = 0.0;
      for (int j = 0; j < 200; ++j) {
        const double time = times[k] + j * width;
        const Quaternion from(motion.at(time).linear()), to(motion.at(time + width).linear());
        fastest = std::max(fastest, from.angularDistance(to) / width);
      }
      EXPECT_LE(fastest, 1.001 * motion.turn_rate({times[k], times[k + 1]}));
    }
  }
}

TEST(MonotoneMotion, EachVertexOfASequenceMovesAsAlone) {
  const std::vector<double> times = {0, 0.4, 1.0, 1.1};
  constexpr int kNumVertices = 2000;  // more than one task has
  std::vector<std::vector<Vec3>> frames;
  for (size_t k = 0; k < times.size(); ++k) {
    std::vector<Vec3> frame;
    for (int v = 0; v < kNumVertices; ++v) {
      const double phase = 0.01 * v + 2.0 * static_cast<double>(k * k);
      frame.push_back(Vec3(std::cos(phase), std::sin(1.7 * phase), v % 7 == 0 ? 1.0 : std::cos(3.0 * phase)));
    }
    frames.push_back(frame);
  }
  const VertexSequence sequence(times, frames, Interpolation::kMonotone);
  const std::vector<Vec3> found = sequence.at(0.7);
  for (int v = 0; v < kNumVertices; ++v) {
    std::vector<Vec3> places;
    for (const std::vector<Vec3>& frame : frames) places.push_back(frame[v]);
    EXPECT_EQ(found[v], place(through(times, places), 0.7));
  }
}

}  // namespace
}  // namespace echopath::test_monotone_motion
