// Every sampler: the right number of points, uniform in area, moved by the seed.
#include <gtest/gtest.h>

#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/trace/launch/launch_points.h"

namespace echopath::test_sampler {
namespace {

constexpr int64_t kCount = 20000;
constexpr double kRim = 1e-12;  // points at the rim, but for rounding
const std::vector<Eigen::Vector2d> kShift = {{0.37, 0.81}}, kOther = {{0.59, 0.12}};

class EverySampler : public ::testing::TestWithParam<Sampler> {};

TEST_P(EverySampler, HasExactlyTheNumberAskedForInsideTheDisc) {
  for (const int64_t count : {0, 1, 7, 4097}) {
    const auto points = launch_points(GetParam(), LaunchDomain{}, count, kShift);
    ASSERT_EQ(points->size(), count);
    for (int64_t i = 0; i < count; ++i) ASSERT_LE(points->point(i).norm(), 1.0 + kRim);
  }
}

// Uniform in area: mean x = 0, mean x^2 = 1/4, and half of the points within radius sqrt(1/2). Five standard errors of
// independent points, 0.5 / sqrt(N) for x; even sets are far better.
TEST_P(EverySampler, IsUniformInArea) {
  const double bound = 5 * 0.5 / std::sqrt(kCount) * (GetParam() == Sampler::kRandom ? 1.0 : 0.1);
  const auto points = launch_points(GetParam(), LaunchDomain{}, kCount, kShift);
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d moment = Eigen::Matrix2d::Zero();
  double inside = 0.0;
  for (int64_t i = 0; i < kCount; ++i) {
    const Eigen::Vector2d point = points->point(i);
    mean += point / kCount;
    moment += point * point.transpose() / kCount;
    inside += point.squaredNorm() < 0.5 ? 1.0 / kCount : 0.0;
  }
  EXPECT_LT(mean.norm(), bound);
  EXPECT_LT((moment - 0.25 * Eigen::Matrix2d::Identity()).norm(), bound);
  EXPECT_NEAR(inside, 0.5, bound);
  EXPECT_NEAR(points->cell_area() * kCount / kPi, 1.0, 0.02);  // the lattice may err by its rim
}

TEST_P(EverySampler, ShiftsMoveThePointsAndMakeBatches) {
  const auto points = launch_points(GetParam(), LaunchDomain{}, 1000, kShift),
             same = launch_points(GetParam(), LaunchDomain{}, 1000, kShift);
  const auto moved = launch_points(GetParam(), LaunchDomain{}, 1000, kOther);
  EXPECT_EQ((points->point(500) - same->point(500)).norm(), 0.0);
  EXPECT_GT((points->point(500) - moved->point(500)).norm(), 1e-6);
  const auto batches = launch_points(GetParam(), LaunchDomain{}, 1001, {kShift[0], kOther[0], {0.2, 0.4}});
  ASSERT_EQ(batches->size(), 1001);
  int64_t count[3] = {0, 0, 0};
  for (int64_t i = 0; i < 1001; ++i) {
    ++count[batches->batch_of(i)];
    ASSERT_LE(batches->point(i).norm(), 1.0 + kRim);
    if (i > 0) {
      ASSERT_GE(batches->batch_of(i), batches->batch_of(i - 1));
    }
  }
  for (const int64_t each : count) EXPECT_NEAR(static_cast<double>(each), 1001.0 / 3, 8.0);  // the lattice by its rim
}

// No two points of an even set come nearer than a part of the cell's side; random ones do.
TEST_P(EverySampler, IsAsEvenAsItSays) {
  constexpr int64_t kFew = 2000;
  const auto points = launch_points(GetParam(), LaunchDomain{}, kFew, kShift);
  double least = 4.0;
  for (int64_t i = 0; i < kFew; ++i) {
    for (int64_t j = 0; j < i; ++j) least = std::min(least, (points->point(i) - points->point(j)).norm());
  }
  const double share = least / std::sqrt(kPi / kFew);
  const bool is_even = GetParam() != Sampler::kRandom;
  EXPECT_EQ(share > 0.3, is_even) << share;
}

INSTANTIATE_TEST_SUITE_P(All, EverySampler,
                         ::testing::Values(Sampler::kLattice, Sampler::kFibonacci, Sampler::kR2, Sampler::kRandom));

}  // namespace
}  // namespace echopath::test_sampler
