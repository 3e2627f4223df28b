// Directions of rays that scatter: each uniform, those of neighbours even.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>

#include "echopath/trace/scatter/scatter_points.h"

namespace echopath::test_scatter_points {
namespace {

TEST(ScatterPoints, NeighboursShareTheSquare) {
  for (const int64_t first : {int64_t{0}, int64_t{7} * kScatterNetSize, int64_t{1} << 40}) {
    for (int columns = 1; columns <= kScatterNetSize; columns *= 2) {
      const int rows = kScatterNetSize / columns;
      std::set<std::pair<int, int>> cells;
      for (int64_t ray = first; ray < first + kScatterNetSize; ++ray) {
        const auto [x, y] = scatter_point(3, 1, ray, 0);
        ASSERT_TRUE(x >= 0 && x < 1 && y >= 0 && y < 1);
        cells.emplace(static_cast<int>(x * columns), static_cast<int>(y * rows));
      }
      EXPECT_EQ(cells.size(), static_cast<size_t>(kScatterNetSize)) << columns;
    }
  }
}

// Over seeds, and so over groups, each ray alone is uniform: means of x, y and xy within five standard errors.
TEST(ScatterPoints, EveryRayIsUniform) {
  constexpr int kSeeds = 20000;
  for (const int64_t ray : {0, 1, 100, 255}) {
    double x_mean = 0.0, y_mean = 0.0, product = 0.0;
    for (uint64_t seed = 0; seed < kSeeds; ++seed) {
      const auto [x, y] = scatter_point(seed, 0, ray, 2);
      x_mean += x / kSeeds;
      y_mean += y / kSeeds;
      product += x * y / kSeeds;
    }
    EXPECT_NEAR(x_mean, 0.5, 5 * std::sqrt(1.0 / 12 / kSeeds)) << ray;
    EXPECT_NEAR(y_mean, 0.5, 5 * std::sqrt(1.0 / 12 / kSeeds)) << ray;
    EXPECT_NEAR(product, 0.25, 5 * std::sqrt(7.0 / 144 / kSeeds)) << ray;
  }
}

// Rays of other groups, batches, hits and seeds do not follow: their correlation is that of chance.
TEST(ScatterPoints, GroupsAreIndependent) {
  constexpr int kCount = 100 * kScatterNetSize;
  const auto correlation = [](uint64_t seed, int batch, int64_t shift, int hit) {
    double sum = 0.0;
    for (int64_t ray = 0; ray < kCount; ++ray) {
      const auto a = scatter_point(1, 0, ray, 0), b = scatter_point(seed, batch, ray + shift, hit);
      sum += 12 * ((a[0] - 0.5) * (b[0] - 0.5) + (a[1] - 0.5) * (b[1] - 0.5)) / (2 * kCount);
    }
    return sum;
  };
  // One number a group decides: a hundred groups, five standard errors.
  const double bound = 5 / std::sqrt(2 * 100.0);
  EXPECT_NEAR(correlation(1, 0, 0, 0), 1.0, 0.05);
  EXPECT_LT(std::abs(correlation(1, 0, kScatterNetSize, 0)), bound);
  EXPECT_LT(std::abs(correlation(1, 1, 0, 0)), bound);
  EXPECT_LT(std::abs(correlation(1, 0, 0, 1)), bound);
  EXPECT_LT(std::abs(correlation(2, 0, 0, 0)), bound);
}

}  // namespace
}  // namespace echopath::test_scatter_points
