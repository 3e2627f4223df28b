// Ways over mirrors against the law of reflection: the wave runs in straight lines, and at each mirror the angles of
// incidence and reflection are equal.
#include "echopath/base/plane.h"

#include <gtest/gtest.h>

#include <random>

namespace echopath::test_plane {
namespace {

constexpr double kRounding = 1e-12;  // m, over ways of some metres

// Two mirrors at a right angle, one along y = 0 and one along x = 0.
const std::vector<Plane> kCorner = {{Vec3(3.0, 0.0, 1.0), Vec3::UnitY()}, {Vec3(0.0, 2.0, -1.0), -Vec3::UnitX()}};

TEST(MirrorChain, AWaveIsMirroredWhereItsWayIsShortest) {
  std::mt19937 draw(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto vector = [&] { return Vec3(uniform(draw), uniform(draw), uniform(draw)); };
  int num_ways = 0;
  for (int i = 0; i < 2000; ++i) {
    std::vector<Plane> mirrors;
    for (int k = 0; k < 3; ++k) mirrors.push_back({3.0 * vector(), vector().normalized()});
    const Vec3 from = vector(), to = vector();
    std::vector<Vec3> way(3);
    if (find_reflections(mirrors, from, to, way.data())) continue;
    ++num_ways;
    way.insert(way.begin(), from);
    way.push_back(to);
    double length = 0.0;
    Vec3 direction = (way[1] - from).normalized();
    for (size_t k = 1; k < way.size(); ++k) {
      length += (way[k] - way[k - 1]).norm();
      EXPECT_LT((direction - (way[k] - way[k - 1]).normalized()).norm(), 1e-9);
      if (k == mirrors.size() + 1) break;
      const Vec3& normal = mirrors[k - 1].normal;
      EXPECT_NEAR(normal.dot(way[k] - mirrors[k - 1].point), 0.0, kRounding * length);
      direction = (Mat3::Identity() - 2.0 * normal * normal.transpose()) * direction;
    }
    EXPECT_NEAR((to - image_over(mirrors, from)).norm(), length, kRounding * length);
    EXPECT_NEAR((image_over_reversed(mirrors, to) - from).norm(), length, kRounding * length);
    EXPECT_LT((mirrored_over_reversed(mirrors, direction) - (way[1] - from).normalized()).norm(), 1e-9);
  }
  EXPECT_GT(num_ways, 20);
}

TEST(MirrorChain, ARightAngleTurnsPointsAboutItsEdge) {
  const Vec3 point(2.0, 3.0, 5.0);
  EXPECT_LT((image_over(kCorner, point) - Vec3(-2.0, -3.0, 5.0)).norm(), kRounding);
  EXPECT_LT((mirrored_over(kCorner, point) - Vec3(-2.0, -3.0, 5.0)).norm(), kRounding);
  EXPECT_LT((reflection(Vec3::UnitY()) * point - Vec3(2.0, -3.0, 5.0)).norm(), kRounding);
  const std::vector<int> order = {1, 0, 1};
  std::vector<Vec3> images(3);
  find_images(chain_of(kCorner, order), point, images.data());
  EXPECT_LT((images[0] - Vec3(-2.0, 3.0, 5.0)).norm() + (images[2] - Vec3(2.0, -3.0, 5.0)).norm(), kRounding);
}

TEST(MirrorChain, TellsWhichMirrorTheWaveMisses) {
  Vec3 points[2];
  EXPECT_FALSE(find_reflections(kCorner, Vec3(2.0, 1.0, 0.0), Vec3(1.0, 2.0, 0.0), points));
  EXPECT_LT((points[0] - Vec3(1.0, 0.0, 0.0)).norm() + (points[1] - Vec3(0.0, 1.0, 0.0)).norm(), kRounding);
  EXPECT_EQ(find_reflections(kCorner, Vec3(1.0, 2.0, 0.0), Vec3(2.0, 1.0, 0.0), points),
            0u);  // it meets the other one first
  EXPECT_EQ(find_reflections(kCorner, Vec3(1.0, 2.0, 0.0), Vec3(-2.0, 1.0, 0.0), points), 1u);
}

// From a point in the corner and back, the wave meets both mirrors in their edge.
TEST(MirrorChain, MirrorsThatMeetShareAPoint) {
  const Vec3 from(2.0, 1.0, 0.5), edge(0.0, 0.0, 0.5);
  Vec3 points[2];
  EXPECT_EQ(find_reflections(kCorner, from, from, points), 0u);
  EXPECT_FALSE(find_reflections(kCorner, from, from, points, 1e-6));
  EXPECT_LT((points[0] - edge).norm() + (points[1] - edge).norm(), kRounding);
  const double lift = 1e-3;
  EXPECT_LT((lifted_off_mirrors(kCorner, points, 0, from, 1e-6, lift) - Vec3(lift, lift, 0.5)).norm(), kRounding);
  points[1] = Vec3(0.0, 1.0, 0.5);
  EXPECT_LT((lifted_off_mirrors(kCorner, points, 0, from, 1e-6, lift) - Vec3(0.0, lift, 0.5)).norm(), kRounding);
}

}  // namespace
}  // namespace echopath::test_plane
