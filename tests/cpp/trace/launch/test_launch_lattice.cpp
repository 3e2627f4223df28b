// The launch lattice: count, area, evenness.
#include <gtest/gtest.h>

#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/trace/launch/launch_lattice.h"

namespace echopath::test_launch_lattice {
namespace {

constexpr double kRim = 1e-12;     // points at the rim, but for rounding
constexpr double kMoments = 3e-4;  // of 1/4: what the rim of a lattice adds

constexpr double kCells = 0.02;  // points along the rim of a long rectangle, of all
constexpr double kSides = 5e-3;  // of 1/3; a random set of 20 000 errs by 2e-3, four rows across a strip by some more

const Eigen::Vector2d kShift(0.37, 0.81);

TEST(LaunchLattice, HasExactlyTheNumberAskedFor) {
  for (const int64_t count : {0, 1, 2, 3, 10, 63, 1000, 4097, 200000}) {
    const LaunchLattice lattice(LaunchDomain{}, count, {kShift});
    ASSERT_EQ(lattice.size(), count);
    for (int64_t i = 0; i < count; ++i) ASSERT_LE(lattice.point(i).norm(), 1.0 + kRim);
    if (count > 100) {
      EXPECT_NEAR(lattice.cell_area() * static_cast<double>(count) / kPi, 1.0, 2.0 / std::sqrt(count));
    }
  }
}

// Moments of the disc: mean x^2 = 1/4, mean x y = 0. A random set of this size errs by about 2e-3.
TEST(LaunchLattice, IsEven) {
  const LaunchLattice lattice(LaunchDomain{}, 20000, {kShift});
  Eigen::Matrix2d moment = Eigen::Matrix2d::Zero();
  for (int64_t i = 0; i < lattice.size(); ++i) moment += lattice.point(i) * lattice.point(i).transpose();
  moment *= lattice.cell_area() / kPi;
  EXPECT_LT((moment - 0.25 * Eigen::Matrix2d::Identity()).norm(), kMoments);
}

// Points of one batch lie whole steps of its lattice apart, whose cell is that of the golden ratio.
TEST(LaunchLattice, EveryPointIsOfTheBatchWhoseLatticeItLiesOn) {
  const LaunchLattice lattice(LaunchDomain{}, 200, {kShift, {0.11, 0.52}, {0.6, 0.2}});
  const double side = std::sqrt(3.0 * lattice.cell_area() / std::sqrt(5.0)), phi = 0.5 + std::sqrt(1.25);
  Eigen::Matrix2d cell;
  cell << side, side * phi, side, side * (1.0 - phi);
  Eigen::Vector2d first[3];
  for (int64_t i = 0, batch = -1; i < lattice.size(); ++i) {
    if (lattice.batch_of(i) != batch) first[++batch] = lattice.point(i);
    ASSERT_EQ(lattice.batch_of(i), batch);
    const Eigen::Vector2d steps = cell.inverse() * (lattice.point(i) - first[batch]);
    EXPECT_LT((steps.array() - steps.array().round()).abs().maxCoeff(), 1e-9) << i;
  }
  EXPECT_EQ(lattice.batch_of(lattice.size() - 1), 2);
}

TEST(LaunchLattice, NeighboursInOrderAreNeighbours) {
  const LaunchLattice lattice(LaunchDomain{}, 10000, {kShift});
  double sum = 0.0;
  for (int64_t i = 1; i < lattice.size(); ++i) sum += (lattice.point(i) - lattice.point(i - 1)).norm();
  EXPECT_LT(sum / 9999.0, 2.0 * std::sqrt(kPi / 10000.0));
}

// Of rectangles up to a thousand times as long as wide: every point inside, the number asked for, even along both sides.
TEST(LaunchLattice, FillsRectanglesEvenly) {
  for (const double length : {1.0, 30.0, 1000.0}) {
    const LaunchDomain rectangle{{0.01 * length, 0.01}};
    for (const int64_t count : {1, 5, 100, 20000}) {
      const LaunchLattice lattice(rectangle, count, {kShift, {0.11, 0.52}});
      ASSERT_EQ(lattice.size(), count) << length;
      for (int64_t i = 0; i < count; ++i) {
        ASSERT_TRUE((lattice.point(i).array().abs() <= rectangle.half.array() * (1.0 + kRim)).all()) << length;
      }
    }
    const LaunchLattice lattice(rectangle, 20000, {kShift});
    EXPECT_NEAR(lattice.cell_area() * 20000.0 / rectangle.area(), 1.0, kCells);
    Eigen::Array2d moment = Eigen::Array2d::Zero();
    for (int64_t i = 0; i < lattice.size(); ++i)
      moment += (lattice.point(i).array() / rectangle.half.array()).square() / 20000.0;
    EXPECT_NEAR(moment[0], 1.0 / 3.0, kSides);  // of uniform points, across each side
    EXPECT_NEAR(moment[1], 1.0 / 3.0, kSides);
  }
}

}  // namespace
}  // namespace echopath::test_launch_lattice
