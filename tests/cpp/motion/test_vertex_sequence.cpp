#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "cpp/support/any_threads.h"
#include "cpp/support/expect_error.h"
#include "echopath/motion/deformation.h"

namespace echopath::test_vertex_sequence {
namespace {

using test::expect_error;
using Invalid = std::invalid_argument;

constexpr double kAngularRate = 5.0;  // rad/s

Vec3 rotating_point(double time, double radius) {
  return {radius * std::cos(kAngularRate * time), radius * std::sin(kAngularRate * time), 1.0};
}

VertexSequence rotating(int num_frames, size_t num_vertices, Interpolation interpolation) {
  std::vector<double> times;
  std::vector<std::vector<Vec3>> frames;
  for (int i = 0; i < num_frames; ++i) {
    times.push_back(static_cast<double>(i) / (num_frames - 1));
    frames.emplace_back();
    for (size_t v = 0; v < num_vertices; ++v) {
      frames.back().push_back(rotating_point(times.back(), 1.0 + static_cast<double>(v)));
    }
  }
  return VertexSequence(times, frames, interpolation);
}

// Largest distance to the circle between two times.
double worst_error(int num_frames, Interpolation interpolation, double begin = 0.0, double end = 1.0) {
  const VertexSequence sequence = rotating(num_frames, 2, interpolation);
  double worst = 0.0;
  for (int i = 0; i <= 2000; ++i) {
    const double time = begin + (end - begin) * i / 2000.0;
    worst = std::max(worst, (sequence.at(time)[0] - rotating_point(time, 1.0)).norm());
  }
  return worst;
}

TEST(VertexSequence, CubicErrorOfARotatingPointFallsWithTheFourthPowerOfTheStep) {
  EXPECT_NEAR(std::log2(worst_error(41, Interpolation::kCubic) / worst_error(81, Interpolation::kCubic)), 4.0, 0.3);
  // Away from the ends at most 5 h^4 / 384 times the fourth derivative is left (Hall and Meyer 1976).
  const double bound = 5.0 / 384.0 * std::pow(kAngularRate / 80.0, 4);
  EXPECT_LT(worst_error(81, Interpolation::kCubic, 0.2, 0.8), bound);
}

TEST(VertexSequence, LinearErrorOfARotatingPointIsTheSagOfTheChord) {
  const double half_step = 0.5 * kAngularRate / 40.0;                                     // rad
  EXPECT_NEAR(worst_error(41, Interpolation::kLinear), 1.0 - std::cos(half_step), 1e-6);  // sampled in time
}

TEST(VertexSequence, AFewVerticesAreTheSameAsThoseOfAll) {
  for (const Interpolation interpolation : {Interpolation::kCubic, Interpolation::kLinear, Interpolation::kMonotone}) {
    const VertexSequence sequence = rotating(9, 1000, interpolation);
    const std::vector<uint32_t> indices = {999, 0, 512, 512};
    std::vector<Vec3> some(7);
    for (const double time : {0.0, 0.123, 1.0}) {
      const std::vector<Vec3> all = sequence.at(time);
      sequence.at(time, indices, some);
      ASSERT_EQ(some.size(), indices.size());
      for (size_t i = 0; i < indices.size(); ++i) EXPECT_EQ(some[i], all[indices[i]]);
    }
  }
}

TEST(VertexSequence, EachVertexMovesAsIfItWereAlone) {
  constexpr size_t kNumVertices = 5000;  // more than one task of the solver
  const VertexSequence together = rotating(12, kNumVertices, Interpolation::kCubic);
  for (const size_t v : {size_t{0}, size_t{681}, size_t{683}, kNumVertices - 1}) {
    std::vector<Vec3> alone;
    for (const std::vector<Vec3>& frame : together.vertices()) alone.push_back(frame[v]);
    const KeyframeMotion single(together.times(), alone, {});
    EXPECT_EQ(together.at(0.37)[v], single.at(0.37).translation());
  }
}

TEST(VertexSequence, BitsDoNotDependOnTheNumberOfThreads) {
  test::same_on_any_threads([] { return rotating(12, 5000, Interpolation::kCubic).at(0.77); });
}

TEST(VertexSequence, NamesItsBreakpointsAndSpan) {
  EXPECT_EQ(rotating(5, 1, Interpolation::kLinear).breakpoints(), (std::vector<double>{0.25, 0.5, 0.75}));
  EXPECT_TRUE(rotating(5, 1, Interpolation::kCubic).breakpoints().empty());
  EXPECT_EQ(rotating(5, 1, Interpolation::kCubic).span().end, 1.0);
}

TEST(VertexSequence, RefusesBadInputByName) {
  const std::vector<Vec3> one = {Vec3::Zero()}, two = {Vec3::Zero(), Vec3::UnitX()};
  const double infinity = std::numeric_limits<double>::infinity();
  expect_error<Invalid>([&] { VertexSequence({0, 1}, {one}); }, {"vertices", "as many frames as times", "got 1"});
  expect_error<Invalid>([&] { VertexSequence({0, 1}, {one, two}); }, {"vertices", "same number", "got 2"});
  expect_error<Invalid>([&] { VertexSequence({0, 1}, {{}, {}}); }, {"vertices", "at least one"});
  expect_error<Invalid>([&] { VertexSequence({0, 1}, {one, {Vec3(infinity, 0, 0)}}); }, {"vertices", "finite"});
  expect_error<Invalid>([&] { VertexSequence({1, 0}, {one, one}); }, {"times"});
  const VertexSequence good({0, 1}, {one, one});
  std::vector<Vec3> out;
  expect_error<Invalid>([&] { good.at(0.5, {1}, out); }, {"indices", "got 1"});
  expect_error<Invalid>([&] { good.at(1.5); }, {"time", "1.5"});
}

}  // namespace
}  // namespace echopath::test_vertex_sequence
