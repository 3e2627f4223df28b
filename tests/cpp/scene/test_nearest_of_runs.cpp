// The nearest point of triangles, against closed forms and against many points of all of them.
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "echopath/scene/runs/nearest_of_runs.h"

namespace echopath::test_nearest_of_runs {
namespace {

constexpr double kAnywhere = std::numeric_limits<double>::infinity();

TEST(NearestOfTriangle, IsFootOfPerpendicularOrLiesOnRim) {
  const std::array<Vec3, 3> corners{Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 3, 0)};
  EXPECT_LT((nearest_of_triangle(corners, {1, 1, 5}) - Vec3(1, 1, 0)).norm(), 1e-12);
  EXPECT_LT((nearest_of_triangle(corners, {2, -3, 1}) - Vec3(2, 0, 0)).norm(), 1e-12);
  EXPECT_LT((nearest_of_triangle(corners, {-1, -2, -1}) - Vec3(0, 0, 0)).norm(), 1e-12);
  // The foot on 3 x + 4 y = 12 of (4, 3): 12 from the line over 25, along (3, 4).
  EXPECT_LT((nearest_of_triangle(corners, {4, 3, 2}) - Vec3(4 - 36.0 / 25, 3 - 48.0 / 25, 0)).norm(), 1e-12);
}

TEST(NearestOfTriangle, TakesTrianglesWithoutArea) {
  const std::array<Vec3, 3> line{Vec3(0, 0, 0), Vec3(1, 1, 1), Vec3(3, 3, 3)},
      point{Vec3(1, 2, 3), Vec3(1, 2, 3), Vec3(1, 2, 3)};
  EXPECT_LT((nearest_of_triangle(line, {2, 2, 2}) - Vec3(2, 2, 2)).norm(), 1e-12);
  EXPECT_LT((nearest_of_triangle(line, {9, 9, 9}) - Vec3(3, 3, 3)).norm(), 1e-12);
  EXPECT_EQ(nearest_of_triangle(point, {7, 7, 7}), Vec3(1, 2, 3));
}

// Triangles all over a room of 10 m, at rest and where a map puts them.
class NearestOfRunsTest : public ::testing::Test {
 protected:
  static constexpr uint32_t kNumTriangles = 203;  // the last run is short
  static constexpr int kPlaces = 12;              // of a side, at which triangles are sampled

  NearestOfRunsTest() {
    for (uint32_t i = 0; i < kNumTriangles; ++i) {
      const Vec3 centre = 5.0 * draw();
      for (int corner = 0; corner < 3; ++corner) vertices_.push_back(centre + draw());
      triangles_.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    boxes_ = find_boxes_of_runs(vertices_, triangles_);
    linear_ =
        Eigen::AngleAxisd(1.1, Vec3(1, 2, 3).normalized()).toRotationMatrix() * Eigen::DiagonalMatrix<double, 3>(2, 1, -0.5);
  }

  Vec3 draw() {
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    return {uniform(random_), uniform(random_), uniform(random_)};
  }
  std::array<Vec3, 3> corners(uint32_t triangle) const {
    std::array<Vec3, 3> corners;
    for (uint32_t k = 0; k < 3; ++k) corners[k] = linear_ * vertices_[3 * triangle + k] + place_;
    return corners;
  }
  // Returns the least distance to points that lie all over the triangles.
  double sampled_distance(const Vec3& point) const {
    double least = kAnywhere;
    for (uint32_t i = 0; i < kNumTriangles; ++i) {
      const auto [a, b, c] = corners(i);
      for (int u = 0; u <= kPlaces; ++u) {
        for (int v = 0; u + v <= kPlaces; ++v)
          least = std::min(least, (a + (u * (b - a) + v * (c - a)) / kPlaces - point).norm());
      }
    }
    return least;
  }

  std::mt19937_64 random_{3};
  std::vector<Vec3> vertices_;
  std::vector<std::array<uint32_t, 3>> triangles_;
  std::vector<Box> boxes_;
  Mat3 linear_;
  Vec3 place_{3.0, -1.0, 40.0};
};

TEST_F(NearestOfRunsTest, FindsWhatAllPointsOfAllTrianglesTell) {
  const NearestOfRuns runs(boxes_, kNumTriangles, FrameOfBoxes::mapped(linear_, place_));
  const auto corners_of = [&](uint32_t triangle) { return corners(triangle); };
  constexpr double kApart =
      2.0 * 2.0 * 1.8 / kPlaces;  // m, of sampled points: sides are at most 2 sqrt(3) m, stretched twice
  for (int trial = 0; trial < 40; ++trial) {
    const Vec3 point = place_ + 14.0 * draw();
    const std::optional<Vec3> nearest = runs.within(kAnywhere, point, corners_of);
    ASSERT_TRUE(nearest.has_value());
    const double distance = (*nearest - point).norm(), sampled = sampled_distance(point);
    EXPECT_LE(distance, sampled * (1.0 + 1e-12));
    EXPECT_GE(distance, sampled - kApart);
    EXPECT_FALSE(runs.within(distance * (1.0 - 1e-9), point, corners_of).has_value());
    EXPECT_EQ(runs.within(distance * (1.0 + 1e-9), point, corners_of), nearest);
  }
}

}  // namespace
}  // namespace echopath::test_nearest_of_runs
