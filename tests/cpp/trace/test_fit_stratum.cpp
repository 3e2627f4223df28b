// Strata that fit what rays aim at.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cpp/support/boxes.h"
#include "echopath/base/constants.h"
#include "echopath/trace/strata/fit_stratum.h"

namespace echopath::test_fit_stratum {
namespace {

using testing::box_corners;

// Whatever its triangles are, a surface lies within the convex hull of its vertices.
void expect_hold(const Stratum& stratum, const std::vector<Vec3>& vertices, const Vec3& apex) {
  std::mt19937 random(7);
  std::exponential_distribution<double> draw;
  for (int i = 0; i < 2000; ++i) {
    Vec3 point = Vec3::Zero();
    double sum = 0.0;
    // Few vertices at a time: points near the rim.
    for (int k = 0; k < 3; ++k) {
      const double part = draw(random);
      point += part * vertices[random() % vertices.size()];
      sum += part;
    }
    ASSERT_TRUE(stratum.contains((point / sum - apex).normalized())) << i;
  }
}

TEST(FitStratum, ASphereGetsItsCone) {
  std::vector<Vec3> vertices;
  std::mt19937 random(1);
  std::normal_distribution<double> draw;
  for (int i = 0; i < 20000; ++i)
    vertices.push_back(Vec3(10, 2, 1) + Vec3(draw(random), draw(random), draw(random)).normalized());
  const Vec3 apex(0.5, 0, 0);
  const auto stratum = fit_stratum(vertices, apex, "ball");
  ASSERT_TRUE(stratum);
  EXPECT_FALSE(stratum->is_strip());
  const double sine = 1.0 / (Vec3(10, 2, 1) - apex).norm();
  EXPECT_NEAR(stratum->versine / (1.0 - std::sqrt(1.0 - sine * sine)), 1.0, 0.04);  // 20 000 points, and the margin
  expect_hold(*stratum, vertices, apex);
}

// A pole .1 m wide and 3 m high 30 m away: .1 x 3 / 30^2 sr, a twenty-fourth of the cone around it.
TEST(FitStratum, APoleGetsAStrip) {
  const std::vector<Vec3> vertices = box_corners({29.95, 0.95, -1}, {30.05, 1.05, 2});
  const auto stratum = fit_stratum(vertices, Vec3::Zero(), "pole");
  ASSERT_TRUE(stratum);
  EXPECT_TRUE(stratum->is_strip());
  EXPECT_NEAR(stratum->solid_angle() / (0.1034 * 3.0 / 901.0), 1.0, 0.05);  // its silhouette is a little wider than a side
  expect_hold(*stratum, vertices, Vec3::Zero());
}

// A straight rail lies along a great circle however long it is; a slanted pole likewise.
TEST(FitStratum, LongThingsKeepThinStrips) {
  const Vec3 apex(0, 0, 1);
  const std::vector<Vec3> rail = box_corners({1, 3.0, 0.4}, {60, 3.1, 0.7});
  const auto along = fit_stratum(rail, apex, "rail");
  ASSERT_TRUE(along);
  EXPECT_TRUE(along->is_strip());
  expect_hold(*along, rail, apex);
  EXPECT_LT(along->solid_angle(), 0.35);  // its own silhouette fills .17 sr, the cone around it 2 sr
  std::vector<Vec3> slanted;
  for (const Vec3& corner : box_corners({-2, -0.02, -0.02}, {2, 0.02, 0.02}))
    slanted.push_back({20, corner[0] + corner[1], corner[0] + corner[2]});
  const auto strip = fit_stratum(slanted, apex, "slanted");
  ASSERT_TRUE(strip);
  expect_hold(*strip, slanted, apex);
  EXPECT_LT(strip->solid_angle(), 0.1 * kPi * 8.0 / 400.0);
}

TEST(FitStratum, HoldsRandomBoxesNearAndFar) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> draw(-1.0, 1.0);
  int num_strips = 0;
  for (int i = 0; i < 100; ++i) {
    const Vec3 middle = Vec3(draw(random), draw(random), draw(random)).normalized() * std::pow(10.0, 1.5 + draw(random));
    const Vec3 half = 2.0 * Vec3(std::abs(draw(random)), std::abs(draw(random)), std::abs(draw(random)));
    const std::vector<Vec3> vertices = box_corners(middle - half, middle + half);
    const auto stratum = fit_stratum(vertices, Vec3::Zero(), "box");
    if (!stratum) continue;
    num_strips += stratum->is_strip();
    expect_hold(*stratum, vertices, Vec3::Zero());
  }
  EXPECT_GT(num_strips, 20);
}

TEST(FitStratum, NothingHoldsWhatSurroundsTheRadar) {
  EXPECT_FALSE(fit_stratum(box_corners({-1, -1, -1}, {1, 1, 1}), Vec3::Zero(), "room"));
  EXPECT_FALSE(fit_stratum({{-50, -50, 0}, {50, -50, 0}, {0, 70, 0}}, {0, 0, 1}, "ground"));
  EXPECT_FALSE(fit_stratum({{1, 2, 3}}, {1, 2, 3}, "the radar itself"));
}

TEST(FitStratum, SamplersForDiscsGetCones) {
  const auto stratum = fit_stratum(box_corners({29.95, 0.95, -1}, {30.05, 1.05, 2}), Vec3::Zero(), "pole", 0);
  ASSERT_TRUE(stratum);
  EXPECT_FALSE(stratum->is_strip());
}

}  // namespace
}  // namespace echopath::test_fit_stratum
