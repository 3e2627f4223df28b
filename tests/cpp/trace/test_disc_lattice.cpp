// The launch lattice: count, area, evenness.
#include <gtest/gtest.h>

#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/trace/disc_lattice.h"

namespace echopath {
namespace {

constexpr double kRim = 1e-12;     // points at the rim, but for rounding
constexpr double kMoments = 3e-4;  // of 1/4: what the rim of a lattice adds

const Eigen::Vector2d kShift(0.37, 0.81);

TEST(DiscLattice, HasExactlyTheNumberAskedFor) {
  for (const int64_t count : {0, 1, 2, 3, 10, 63, 1000, 4097, 200000}) {
    const DiscLattice lattice(count, kShift);
    ASSERT_EQ(lattice.size(), count);
    for (int64_t i = 0; i < count; ++i) ASSERT_LE(lattice.point(i).norm(), 1.0 + kRim);
    if (count > 100) {
      EXPECT_NEAR(lattice.cell_area() * static_cast<double>(count) / kPi, 1.0, 2.0 / std::sqrt(count));
    }
  }
}

// Moments of the disc: mean x^2 = 1/4, mean x y = 0. A random set of this size errs by about 2e-3.
TEST(DiscLattice, IsEven) {
  const DiscLattice lattice(20000, kShift);
  Eigen::Matrix2d moment = Eigen::Matrix2d::Zero();
  for (int64_t i = 0; i < lattice.size(); ++i) moment += lattice.point(i) * lattice.point(i).transpose();
  moment *= lattice.cell_area() / kPi;
  EXPECT_LT((moment - 0.25 * Eigen::Matrix2d::Identity()).norm(), kMoments);
}

TEST(DiscLattice, NeighboursInOrderAreNeighbours) {
  const DiscLattice lattice(10000, kShift);
  double sum = 0.0;
  for (int64_t i = 1; i < lattice.size(); ++i) sum += (lattice.point(i) - lattice.point(i - 1)).norm();
  EXPECT_LT(sum / 9999.0, 2.0 * std::sqrt(kPi / 10000.0));
}

}  // namespace
}  // namespace echopath
