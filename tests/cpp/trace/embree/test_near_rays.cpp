// Rays that look no farther than some reach: a large wall is met where its distance along the ray, in closed form, lies
// within the reach, as a ray without end meets it, and not where it lies far beyond.
#include <gtest/gtest.h>

#include <random>

#include "cpp/support/scenes.h"
#include "echopath/trace/embree/embree_scene.h"

namespace echopath::test_near_rays {
namespace {

using namespace testing;

constexpr double kDistance = 3.0;  // m, of the wall x = 3
constexpr double kBeyond = 1.01;   // times the reach: farther than what a ray may meet behind its end

Scene wall() {
  Surface surface;
  surface.vertices = {{kDistance, -50, -50}, {kDistance, 50, -50}, {kDistance, 50, 50}, {kDistance, -50, 50}};
  surface.triangles = {{0, 1, 2}, {0, 2, 3}};
  Node node = node_with("wall", surface, lambert(0.5));
  Scene scene;
  scene.add(node);
  return scene;
}

TEST(NearRays, MeetWhatLiesWithinTheirReachAndNothingFarBeyond) {
  const Scene scene = wall();
  const EmbreeScene geometry(scene, PosedScene(scene, 0.0), Vec3::Zero());
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int num_met = 0, num_missed = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 direction = Vec3(1.0, 2.0 * uniform(random), 2.0 * uniform(random)).normalized();
    const double distance = kDistance / direction.x(), reach = distance * (1.0 + 0.5 * uniform(random));
    RayHit near, far;
    const auto met = geometry.intersect_near(Vec3::Zero(), direction, reach, near, Sees::kOpaque);
    if (distance > kBeyond * reach + 0.01) {
      EXPECT_EQ(met, EmbreeScene::Verdict::kMiss) << i;
      ++num_missed;
    } else if (distance <= reach) {
      ASSERT_EQ(met, EmbreeScene::Verdict::kHit) << i;
      EXPECT_NEAR(near.distance, distance, 1e-5 * distance);
      ASSERT_EQ(geometry.intersect_from_surface(Vec3::Zero(), direction, far), EmbreeScene::Verdict::kHit);
      EXPECT_EQ(near.position, far.position);
      ++num_met;
    }
  }
  EXPECT_GT(num_met, 500);
  EXPECT_GT(num_missed, 500);
}

TEST(NearRays, ReachWhatLiesAtTheirVeryEnd) {
  const Scene scene = wall();
  const EmbreeScene geometry(scene, PosedScene(scene, 0.0), Vec3::Zero());
  for (int i = 0; i < 200; ++i) {
    const Vec3 direction = Vec3(1.0, 0.02 * i, 0.07 * i).normalized();
    RayHit met;
    EXPECT_EQ(geometry.intersect_near(Vec3::Zero(), direction, kDistance / direction.x(), met, Sees::kOpaque),
              EmbreeScene::Verdict::kHit)
        << i;
  }
}

}  // namespace
}  // namespace echopath::test_near_rays
