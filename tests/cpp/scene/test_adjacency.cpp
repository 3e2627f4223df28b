#include "echopath/scene/mesh/adjacency.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace echopath::test_adjacency {
namespace {

TEST(Adjacency, TrianglesOfASquareMeetAtItsDiagonalAlone) {
  const auto across = edge_neighbours({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
  EXPECT_EQ(across[0], (std::array<uint32_t, 3>{kNoTriangle, kNoTriangle, 1}));
  EXPECT_EQ(across[1], (std::array<uint32_t, 3>{0, kNoTriangle, kNoTriangle}));
}

TEST(Adjacency, SeamsOfRepeatedVerticesDoNotCount) {
  const auto across =
      edge_neighbours({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {3, 4, 5}});
  EXPECT_EQ(across[0][2], 1u);
  EXPECT_EQ(across[1][0], 0u);
}

TEST(Adjacency, ClosedSurfaceHasNeighboursEverywhereAndEachNeighbourKnowsItsOwn) {
  const std::vector<Triangle> tetrahedron = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
  const auto across = edge_neighbours({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, tetrahedron);
  for (uint32_t t = 0; t < 4; ++t) {
    for (const uint32_t other : across[t]) {
      ASSERT_NE(other, kNoTriangle);
      EXPECT_EQ(std::count(across[other].begin(), across[other].end(), t), 1);
    }
  }
}

TEST(Adjacency, EdgeOfThreeTrianglesLeadsNowhere) {
  const auto across =
      edge_neighbours({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}}, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  for (const auto& sides : across) EXPECT_EQ(std::count(sides.begin(), sides.end(), kNoTriangle), 3);
}

}  // namespace
}  // namespace echopath::test_adjacency
