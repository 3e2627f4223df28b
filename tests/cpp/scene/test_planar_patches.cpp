#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cpp/support/boxes.h"
#include "echopath/scene/edges/patch_sizes.h"
#include "echopath/scene/edges/planar_patches.h"

namespace echopath::test_planar_patches {
namespace {

using Patches = std::vector<std::vector<uint32_t>>;

TEST(PlanarPatches, ABoxHasSixPlanesOfTwoTriangles) {
  const Patches expected = {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {8, 9}, {10, 11}};
  EXPECT_EQ(planar_patches(testing::box_corners(Vec3::Zero(), Vec3::Ones()), testing::kBoxTriangles, 1e-6), expected);
}

// A wall of many triangles with noise below the tolerance, and a plane across its last edge.
TEST(PlanarPatches, JoinTrianglesWithinTheToleranceAndNoOthers) {
  constexpr uint32_t kSide = 12;
  std::mt19937 draw(3);
  std::uniform_real_distribution<double> noise(-5e-6, 5e-6);
  std::vector<Vec3> vertices;
  for (uint32_t row = 0; row <= kSide; ++row) {
    for (uint32_t column = 0; column <= kSide; ++column)
      vertices.emplace_back(row == kSide ? 0.5 : noise(draw), 0.1 * column, 0.1 * row);
  }
  std::vector<Triangle> triangles;
  for (uint32_t row = 0; row < kSide; ++row) {
    for (uint32_t column = 0; column < kSide; ++column) {
      const uint32_t a = row * (kSide + 1) + column, b = a + kSide + 1;
      triangles.push_back({a, a + 1, b + 1});
      triangles.push_back({a, b + 1, b});
    }
  }
  const Patches found = planar_patches(vertices, triangles, 1e-4);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].size(), 2 * kSide);  // the slope has the largest triangles
  EXPECT_EQ(found[1].size(), 2 * kSide * (kSide - 1));
  EXPECT_EQ(planar_patches({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}}, {{0, 1, 2}, {3, 4, 5}}, 1e-4),
            (Patches{{0}, {1}}));  // they do not touch
}

// A sill below two strips beside each other, whose corners lie on its side, and a wall at right angles on the same line.
TEST(PlanarPatches, GoOnWhereCornersLieOnTheSidesOfOthers) {
  const std::vector<Vec3> vertices = {{0, 0, 0},   {9, 0, 0},   {9, 0, 1}, {0, 0, 1},   {0, 0, 1},
                                      {3.3, 0, 1}, {3.3, 0, 4}, {0, 0, 4}, {3.3, 0, 1}, {9, 0, 1},
                                      {9, 0, 4},   {3.3, 0, 4}, {2, 0, 1}, {7, 0, 1},   {7, -2, 1}};
  const std::vector<Triangle> triangles = {{0, 1, 2},  {0, 2, 3},   {4, 5, 6},   {4, 6, 7},
                                           {8, 9, 10}, {8, 10, 11}, {12, 13, 14}};
  EXPECT_EQ(planar_patches(vertices, triangles, 1e-4), (Patches{{0, 1, 2, 3, 4, 5}, {6}}));
  std::vector<Vec3> apart = vertices;
  for (size_t i = 4; i < 12; ++i) apart[i].z() += 2e-4;  // a gap above the sill, wider than the tolerance
  EXPECT_EQ(planar_patches(apart, triangles, 1e-4), (Patches{{2, 3, 4, 5}, {6}, {0, 1}}));
}

TEST(PlanarPatches, GoOnThroughEdgesOfMoreThanTwoTrianglesAndHoldThoseListedTwice) {
  const std::vector<Vec3> cross = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  EXPECT_EQ(planar_patches(cross, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {0, 1, 5}}, 1e-4), (Patches{{0, 1}, {2, 3}}));
  EXPECT_EQ(planar_patches(cross, {{0, 1, 2}, {0, 2, 1}, {0, 1, 3}}, 1e-4), (Patches{{0, 1, 2}}));
}

TEST(TriangleContacts, OpenLengthIsThatOfTheRimHoweverTheSquareIsCut) {
  const std::vector<Vec3> vertices = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {1, 0, 0}, {2, 2, 0}, {3, 3, 0}};
  const std::vector<Triangle> triangles = {
      {0, 2, 3}, {0, 4, 5}, {4, 1, 5}, {5, 1, 6}, {6, 1, 2}};  // the diagonal in three parts
  const TriangleContacts contacts(vertices, triangles, 1e-4);
  double length = 0.0;
  for (uint32_t t = 0; t < triangles.size(); ++t) length += contacts.open_length(t, [](uint32_t) { return true; });
  EXPECT_NEAR(length, 16.0, 1e-12);
  EXPECT_NEAR(contacts.open_length(0, [](uint32_t other) { return other != 1; }), 8.0 + std::sqrt(8.0), 1e-12);
}

TEST(TriangleContacts, ATriangleListedTwiceHasTwoRims) {
  const std::vector<Vec3> vertices = {{0, 0, 0}, {3, 0, 0}, {0, 4, 0}};
  const std::vector<Triangle> triangles = {{0, 1, 2}, {0, 2, 1}};
  const TriangleContacts contacts(vertices, triangles, 1e-4);
  for (uint32_t t = 0; t < 2; ++t) EXPECT_NEAR(contacts.open_length(t, [](uint32_t) { return true; }), 12.0, 1e-12);
}

// A floor of `side` by `side` squares of 1 m, and a triangle of its own that stands apart.
MeshPtr tiled_floor(uint32_t side) {
  std::vector<Vec3> vertices;
  for (uint32_t i = 0; i <= side; ++i)
    for (uint32_t k = 0; k <= side; ++k) vertices.emplace_back(i, k, 0);
  std::vector<Triangle> triangles;
  for (uint32_t i = 0; i < side; ++i) {
    for (uint32_t k = 0; k < side; ++k) {
      const uint32_t a = i * (side + 1) + k, b = a + side + 1;
      triangles.push_back({a, b, b + 1});
      triangles.push_back({a, b + 1, a + 1});
    }
  }
  const auto first = static_cast<uint32_t>(vertices.size());
  vertices.insert(vertices.end(), {{0, 0, 5}, {1, 0, 5}, {0, 1, 6}});
  triangles.push_back({first, first + 1, first + 2});
  return std::make_shared<const Mesh>(vertices, triangles);
}

// Under a place that doubles x and turns about z: 2 side^2 m^2 within a rim of 6 side m, for few and for many triangles.
TEST(PatchSizes, AreThoseOfThePlacedMesh) {
  Mat3 linear = Eigen::AngleAxisd(0.3, Vec3::UnitZ()).toRotationMatrix();
  linear.col(0) *= 2.0;
  for (const uint32_t side : {3u, 140u}) {
    const MeshPtr floor = tiled_floor(side);
    const auto found = patch_sizes(floor, linear), doubled = patch_sizes(floor, Mat3(2.0 * linear));
    ASSERT_EQ(found->ends, std::vector<uint32_t>{2 * side * side});  // the triangle apart is a plane of one
    EXPECT_NEAR(found->area[0], 2.0 * side * side, 1e-9 * side * side);
    EXPECT_NEAR(found->rim[0], 6.0 * side, 1e-9 * side);
    EXPECT_NEAR(doubled->area[0], 8.0 * side * side, 1e-9 * side * side);
    EXPECT_EQ(found->of_plane(0).back(), 2 * side * side - 1);
    EXPECT_EQ(patch_sizes(floor, linear) == found, side == 140u);  // which is kept
  }
}

}  // namespace
}  // namespace echopath::test_planar_patches
