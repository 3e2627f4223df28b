// A bounce off a curved mirror: sphere -> 5 cm plate -> receiver, against quadrature (the plate's normal is the bisector).
#include <gtest/gtest.h>

#include "echopath/trace/mirror_paths.h"
#include "support/scenes.h"

namespace echopath {
namespace {

using namespace testing;

constexpr double kLevelTolerance = 0.15;  // dB

Vec3 specular_point(const Vec3& centre, double radius, const Vec3& target) {
  Vec3 normal = (-centre.normalized() + (target - centre).normalized()).normalized();
  for (int i = 0; i < 200; ++i) {  // the normal bisects the directions to the antenna (at 0) and to the target
    const Vec3 point = centre + radius * normal;
    normal = (normal + 0.5 * ((-point).normalized() + (target - point).normalized()).normalized()).normalized();
  }
  return centre + radius * normal;
}

// Rays only where they reach the plate: a narrow cone around the specular direction.
double level_dbw(const Vec3& centre, double radius, const Vec3& plate) {
  constexpr double kSide = 0.05;
  const Vec3 specular = specular_point(centre, radius, plate);
  const Vec3 normal = ((specular - plate).normalized() - plate.normalized()).normalized();
  const Vec3 a = normal.cross(Vec3::UnitZ()).normalized(), b = normal.cross(a);
  Scene scene;
  Surface surface = ellipsoid(centre, Vec3::Constant(radius), 7);
  Node ball;
  ball.name = "ball";
  ball.mesh = std::make_shared<Mesh>(std::move(surface.vertices), std::move(surface.triangles));
  ball.material = share(Material::metal());
  ball.smooth = true;
  scene.add(ball);
  add_rectangle(scene, "plate", plate - 0.5 * kSide * (a + b), kSide * a, kSide * b, share(Material::metal()));

  Paths paths;
  paths.scene = std::make_shared<const Scene>(scene);
  paths.radar = plain_radar(Vec3::Zero(), Vec3::Zero());
  const EmbreeScene geometry(*paths.scene, Pose(*paths.scene, 0.0), Vec3::Zero());
  LaunchPlan plan;
  Stratum cone;
  cone.axis = specular.normalized();
  const double reach = (plate - specular).norm();
  const double half_angle = 4.0 * kSide / (2.0 * reach / radius * specular.norm() + reach);
  cone.versine = 0.5 * half_angle * half_angle;
  plan.points.push_back(disc_points(Sampler::kLattice, 1 << 14, {{0.3, 0.6}}));
  cone.num_rays = plan.points[0]->size();
  cone.ray_density = kPi / plan.points[0]->cell_area() / cone.solid_angle();
  plan.strata = {cone};
  plan.first_ray = {0, cone.num_rays};
  SbrSettings settings;
  settings.max_bounces = 2;
  const std::vector<Mirror> no_mirrors;
  const RayShooter shooter(*paths.scene, geometry, no_mirrors, plan, settings);
  std::vector<PathBlock> blocks(1);
  for (int64_t ray = 0; ray < cone.num_rays; ++ray) shooter.shoot(ray, blocks[0]);
  join_blocks(blocks, paths);
  paths.frame.strata = plan.strata;
  std::vector<uint8_t> forward, backward;
  for (size_t i = 0; i < paths.num_bounces.size(); ++i) {
    const bool is_reversed = (paths.flags[i] & kReversedPath) != 0;
    forward.push_back(paths.num_bounces[i] == 2 && !is_reversed);
    backward.push_back(paths.num_bounces[i] == 2 && is_reversed);
  }
  const std::complex<double> there = coherent_sum(paths.select(forward)), back = coherent_sum(paths.select(backward));
  // The plate is no mirror, so the opposite order is the reversal: between co-located antennas it is the same.
  EXPECT_LT(std::abs(there - back), 1e-9 * std::abs(there));
  return decibel(std::norm(there));
}

TEST(CurvedBounce, SphereThenPlateHasItsLevel) {
  EXPECT_NEAR(level_dbw({5, 0, 0}, 0.1, {4.3, 1, .1}), -133.24, kLevelTolerance);
  EXPECT_NEAR(level_dbw({5, 0, 0}, 0.1, {5.3, .8, 0}), -128.66, kLevelTolerance);
  EXPECT_NEAR(level_dbw({5, 0, 0}, 0.4, {5.3, .9, 0}), -117.43, kLevelTolerance);
  EXPECT_NEAR(level_dbw({5, 0, 0}, 0.4, {4.3, 1, .1}), -119.31, kLevelTolerance);
  EXPECT_NEAR(level_dbw({7, 0, 0}, 2.0, {4, 1.5, 0}), -115.42, kLevelTolerance);
}

}  // namespace
}  // namespace echopath
