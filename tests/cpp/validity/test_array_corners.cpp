// Which antennas of an array speak for all of it.
#include <gtest/gtest.h>

#include "echopath/validity/array_corners.h"

namespace echopath::test_array_corners {
namespace {

std::vector<Antenna> antennas(const std::vector<Vec3>& positions) {
  std::vector<Antenna> out;
  for (const Vec3& position : positions) out.emplace_back().position = position;
  return out;
}

TEST(ArrayCorners, AreTheEndsOfALineAndTheCornersOfARectangle) {
  EXPECT_TRUE(array_corners(antennas({{1, 2, 3}})).empty());
  EXPECT_TRUE(array_corners(antennas({{1, 2, 3}, {1, 2, 3}})).empty());
  EXPECT_EQ(array_corners(antennas({{0, 0.1, 1}, {0, 0, 1}, {0, 0.3, 1}, {0, 0.2, 1}})), (std::vector<int>{1, 2}));
  std::vector<Vec3> grid;
  for (int y = 0; y < 5; ++y) {
    for (int z = 0; z < 3; ++z) grid.push_back({0, 0.1 * y, 0.1 * z});
  }
  EXPECT_EQ(array_corners(antennas(grid)), (std::vector<int>{0, 2, 12, 14}));
}

}  // namespace
}  // namespace echopath::test_array_corners
