// Errors of sums over a lattice, by differences between neighbours: against how much such sums scatter.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "echopath/power/interval/row_differences.h"
#include "echopath/record/paths.h"
#include "echopath/trace/launch/launch_lattice.h"

namespace echopath::test_row_differences {
namespace {

using Power = std::function<double(const Eigen::Vector2d&)>;  // of a ray at a point of the unit disc

int place_at(int64_t index) { return place_in_row(place_flags(index)); }

struct Scatter {
  double variance = 0.0, estimate = 0.0;  // of the sums of many lattices; mean of what they say themselves
};

// Moves a lattice of `num_rays` at random, and the body a little. Rays that send nothing back are in no record.
Scatter scatter_of(int64_t num_rays, const Power& power) {
  constexpr int kLattices = 120;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform;
  double sum_of_sums = 0.0, sum_of_squares = 0.0;
  Scatter out;
  for (int i = 0; i < kLattices; ++i) {
    const LaunchLattice lattice(LaunchDomain{}, num_rays, {Eigen::Vector2d(uniform(random), uniform(random))});
    const Eigen::Vector2d moved(0.05 * uniform(random), 0.05 * uniform(random));
    RowDifferences rows;
    double sum = 0.0;
    for (int64_t ray = 0; ray < lattice.size(); ++ray) {
      const double of_ray = power(lattice.point(ray) + moved);
      if (of_ray > 0.0) rows.add(place_at(ray), of_ray);
      sum += of_ray;
    }
    sum_of_sums += sum / kLattices;
    sum_of_squares += sum * sum / kLattices;
    out.estimate += rows.variance() / kLattices;
  }
  out.variance = sum_of_squares - sum_of_sums * sum_of_sums;
  return out;
}

// A body with an outline, and many small ones. 120 lattices know their error to 7 %; it is told at most a fifth too small,
// and twice too large.
TEST(RowDifferences, TellTheErrorOfALatticeOverDiscs) {
  const auto is_in_disc = [](const Eigen::Vector2d& at, double x, double y, double radius) {
    return (at - Eigen::Vector2d(x, y)).norm() < radius;
  };
  const Power one = [&](const Eigen::Vector2d& at) { return is_in_disc(at, 0.03, -0.02, 0.6) ? 1.0 : 0.0; };
  const Power many = [&](const Eigen::Vector2d& at) {
    double power = 0.0;
    for (int k = 0; k < 40; ++k) {
      if (is_in_disc(at, 0.7 * std::sin(12.9898 * k), 0.6 * std::sin(78.233 * k), 0.04 + 0.001 * k)) power = 0.3 + 0.02 * k;
    }
    return power;
  };
  for (const Power& power : {one, many}) {
    for (const int64_t num_rays : {800, 4000}) {
      const Scatter found = scatter_of(num_rays, power);
      EXPECT_GT(std::sqrt(found.estimate / found.variance), 0.8) << num_rays;
      EXPECT_LT(std::sqrt(found.estimate / found.variance), 2.0) << num_rays;
    }
  }
}

// Where no ray tells anything of the next, the variances of all rays add up, also that of whether a ray hits: a power u,
// uniform in 0 to 1, of 60 % of the rays has the mean .3 and the mean square .2.
TEST(RowDifferences, OfIndependentRaysAddUpTheirVariances) {
  constexpr int64_t kRays = 200000;
  constexpr double kShare = 0.6, kVarianceOfOne = 0.2 - 0.3 * 0.3, kChance = 0.03;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform;
  RowDifferences rows;
  for (int64_t ray = 0; ray < kRays; ++ray) {
    if (uniform(random) < kShare) rows.add(place_at(ray), uniform(random));
  }
  EXPECT_NEAR(rows.variance() / (kRays * kVarianceOfOne), 1.0, kChance);
}

// A slope has four times as large differences between every other ray as between neighbours, and no jumps but at its ends; a
// step has nothing else.
TEST(RowDifferences, SlopesAreNoJumps) {
  constexpr int kRays = 30;
  RowDifferences slope, step;
  for (int64_t ray = 0; ray <= 2 * kRays; ++ray) {
    const auto from_end = static_cast<double>(std::min<int64_t>(ray, 2 * kRays - ray));
    if (from_end > 0.0) slope.add(place_at(ray), from_end);
    step.add(place_at(ray), 1.0);
  }
  EXPECT_LT(slope.variance_of_jumps(), 0.05 * slope.variance());
  EXPECT_DOUBLE_EQ(step.variance_of_jumps(), step.variance());
  EXPECT_DOUBLE_EQ(RowDifferences{}.variance_of_jumps(), 0.0);
}

// Lone hits are as uneven as their number. Several hits of one ray, which a sheet may part, are one power.
TEST(RowDifferences, LoneHitsHaveTheVarianceOfACount) {
  RowDifferences rows, parted;
  for (int64_t k = 1; k <= 10; ++k) {
    rows.add(place_at(10 * k), 2.0);
    for (int i = 0; i < 4; ++i) parted.add(place_at(10 * k), 0.5);
  }
  EXPECT_DOUBLE_EQ(rows.variance(), 10 * 2.0 * 2.0);
  EXPECT_DOUBLE_EQ(parted.variance(), rows.variance());
  EXPECT_EQ(RowDifferences().variance(), 0.0);
}

// Rays that all send back the same err nowhere but at both ends of their row.
TEST(RowDifferences, EvenRowsErrAtTheirEnds) {
  constexpr double kAtOutlines = 0.34;
  RowDifferences rows;
  for (int64_t ray = 5; ray < 1005; ++ray) rows.add(place_at(ray), 1.0);
  EXPECT_DOUBLE_EQ(rows.variance(), kAtOutlines * (0.5 + 0.5));
}

}  // namespace
}  // namespace echopath::test_row_differences
