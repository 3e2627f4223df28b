#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "echopath/scene/polygons/triangulate.h"

namespace echopath::test_triangulate {
namespace {

constexpr double kRounding = 1e-9;  // of the sum of thousands of areas

double turn(const Vec3& a, const Vec3& b, const Vec3& c) { return (b - a).cross(c - b).z(); }

// Cuts ears as the definition has it: the first corner of those left that turns left and whose triangle holds no other.
std::vector<Triangle> slow_ears(const std::vector<Vec3>& points) {
  std::vector<uint32_t> rest(points.size());
  for (uint32_t i = 0; i < rest.size(); ++i) rest[i] = i;
  std::vector<Triangle> triangles;
  const auto is_ear = [&](size_t i) {
    const size_t n = rest.size();
    const Vec3 &a = points[rest[(i + n - 1) % n]], &b = points[rest[i]], &c = points[rest[(i + 1) % n]];
    if (turn(a, b, c) <= 0.0) return false;
    for (size_t k = 2; k + 1 < n; ++k) {
      const Vec3& p = points[rest[(i + k) % n]];
      if (turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0) return false;
    }
    return true;
  };
  while (rest.size() > 3) {
    size_t i = 0;
    while (i < rest.size() && !is_ear(i)) ++i;
    if (i == rest.size()) break;
    const size_t n = rest.size();
    triangles.push_back({rest[(i + n - 1) % n], rest[i], rest[(i + 1) % n]});
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
  }
  for (size_t i = 1; i + 1 < rest.size(); ++i) triangles.push_back({rest[0], rest[i], rest[i + 1]});
  return triangles;
}

// A polygon that every ray from its middle leaves once.
std::vector<Vec3> ragged_star(int num_corners, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Vec3> points;
  for (int i = 0; i < num_corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / num_corners,
                 radius = 1.0 + 0.9 * (static_cast<double>(random()) / 4294967296.0);
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0.0);
  }
  return points;
}

// Two arms about each other, `num_corners` long.
std::vector<Vec3> spiral(int num_corners) {
  std::vector<Vec3> points;
  const int half = num_corners / 2;
  for (int i = 0; i < 2 * half; ++i) {
    const int along = i < half ? i : 2 * half - 1 - i;
    const double angle = 40.0 * along / half, radius = 4.0 + angle + (i < half ? 0.0 : -2.0);
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0.0);
  }
  return points;
}

std::vector<Vec3> comb(int num_corners) {
  std::vector<Vec3> points;
  for (int i = 0; i < num_corners; ++i) points.emplace_back(num_corners - i, i % 2 ? 1.0 : 2.0, 0.0);
  points.emplace_back(0.0, 0.0, 0.0);
  points.emplace_back(num_corners + 1.0, 0.0, 0.0);
  return points;
}

double area_of_outline(const std::vector<Vec3>& points) {
  double twice = 0.0;
  for (size_t i = 0; i < points.size(); ++i) twice += points[i].cross(points[(i + 1) % points.size()]).z();
  return 0.5 * twice;
}

std::vector<Triangle> cut(const std::vector<Vec3>& points) {
  std::vector<uint32_t> corners(points.size());
  for (uint32_t i = 0; i < corners.size(); ++i) corners[i] = i;
  return triangulate(points, corners);
}

// Triangles of one direction whose areas add up to that of the outline can neither overlap nor leave a gap.
void expect_tiling(const std::vector<Vec3>& points) {
  const std::vector<Triangle> triangles = cut(points);
  EXPECT_EQ(triangles.size(), points.size() - 2);
  double sum = 0.0;
  for (const Triangle& t : triangles) {
    const double twice = turn(points[t[0]], points[t[1]], points[t[2]]);
    EXPECT_GE(twice, 0.0);
    sum += 0.5 * twice;
  }
  EXPECT_NEAR(sum, area_of_outline(points), kRounding * area_of_outline(points));
}

TEST(Triangulate, CutsTheEarsOfTheDefinitionInItsOrder) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    const std::vector<Vec3> points = ragged_star(12 + 7 * static_cast<int>(seed), seed);
    EXPECT_EQ(cut(points), slow_ears(points)) << seed;
  }
  EXPECT_EQ(cut(spiral(300)), slow_ears(spiral(300)));
  EXPECT_EQ(cut(comb(200)), slow_ears(comb(200)));
}

// The definition takes minutes here.
TEST(Triangulate, TilesPolygonsOfVeryManyCorners) {
  expect_tiling(ragged_star(100000, 3));
  expect_tiling(spiral(100000));
  expect_tiling(comb(100000));
}

TEST(Triangulate, GivesAsManyTrianglesWhereAPolygonCrossesItself) {
  std::mt19937 random(7);
  for (const int num_corners : {4, 5, 17, 3000}) {
    std::vector<Vec3> points;
    for (int i = 0; i < num_corners; ++i) points.emplace_back(random() % 1000, random() % 1000, random() % 10);
    EXPECT_EQ(cut(points).size(), points.size() - 2);
  }
}

}  // namespace
}  // namespace echopath::test_triangulate
