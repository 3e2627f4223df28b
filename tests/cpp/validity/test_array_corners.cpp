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

// Ten times as long as it is wide: its corners are those of its shape, not the ends of its length four times.
TEST(ArrayCorners, LengthAndWidthCountAlike) {
  std::vector<Vec3> places;
  for (const double sign : {1.0, -1.0}) {
    for (const Vec3& at : {Vec3(0, 0.1, 0), Vec3(0, 0, 0.01), Vec3(0, 0.08, 0.008), Vec3(0, 0.08, -0.008)})
      places.push_back(Vec3(1, 2, 3) + sign * at);
  }
  places.emplace_back(1, 2.03, 3.003);
  EXPECT_EQ(array_corners(antennas(places)), (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7}));
}

}  // namespace
}  // namespace echopath::test_array_corners
