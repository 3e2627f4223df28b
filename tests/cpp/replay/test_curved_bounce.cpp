// A bounce off a curved mirror: sphere -> 5 cm plate -> receiver, against quadrature (the plate's normal is the bisector).
#include <gtest/gtest.h>

#include <tuple>

#include "cpp/support/scenes.h"
#include "echopath/record/blocks/record_writer.h"
#include "echopath/trace/mirrors/mirror_paths.h"

namespace echopath::test_curved_bounce {
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

struct Scenery {
  Scene scene;
  LaunchPlan plan;
};

// Sphere and plate of metal; rays only where they reach the plate: a narrow cone around the specular direction.
Scenery scenery(const Vec3& centre, double radius, const Vec3& plate) {
  constexpr double kSide = 0.05;
  const Vec3 specular = specular_point(centre, radius, plate);
  const Vec3 normal = ((specular - plate).normalized() - plate.normalized()).normalized();
  const Vec3 a = normal.cross(Vec3::UnitZ()).normalized(), b = normal.cross(a);
  Scenery made;
  add_smooth_ball(made.scene, "ball", centre, radius, 7);
  add_rectangle(made.scene, "plate", plate - 0.5 * kSide * (a + b), kSide * a, kSide * b, share(Material::metal()));
  Stratum cone;
  cone.axis = specular.normalized();
  const double reach = (plate - specular).norm();
  const double half_angle = 4.0 * kSide / (2.0 * reach / radius * specular.norm() + reach);
  cone.versine = 0.5 * half_angle * half_angle;
  made.plan.points.push_back(launch_points(Sampler::kLattice, LaunchDomain{}, 1 << 14, {{0.3, 0.6}}));
  cone.num_rays = made.plan.points[0]->size();
  cone.ray_density = kPi / made.plan.points[0]->cell_area() / cone.solid_angle();
  made.plan.strata = {cone};
  made.plan.first_ray = {0, cone.num_rays};
  return made;
}

// Double bounces in the order of the rays, and the reversed ones.
struct DoubleBounces {
  Paths forward, backward;
};

DoubleBounces double_bounces(const Scenery& scenery, const EmbreeScene& geometry, bool is_polarized) {
  Paths paths;
  paths.scene = std::make_shared<const Scene>(scenery.scene);
  paths.radar = plain_radar(Vec3::Zero(), Vec3::Zero());
  SbrSettings settings;
  settings.max_bounces = 2;
  settings.is_polarized = is_polarized;
  const std::vector<Mirror> no_mirrors;
  const AntennaFrusta no_frusta;
  const RayShooter shooter(*paths.scene, geometry, no_mirrors, scenery.plan, settings, no_frusta);
  PathBlock block;
  shooter.shoot(0, scenery.plan.first_ray.back(), block);
  RecordWriter record(paths);
  record.append({&block});
  record.finish();
  paths.frame.strata = scenery.plan.strata;
  std::vector<uint8_t> forward, backward;
  for (size_t i = 0; i < paths.num_bounces.size(); ++i) {
    const bool is_reversed = (paths.flags[i] & kReversedPath) != 0;
    forward.push_back(paths.num_bounces[i] == 2 && !is_reversed);
    backward.push_back(paths.num_bounces[i] == 2 && is_reversed);
  }
  return {paths.select(forward), paths.select(backward)};
}

// The plate is no mirror, so the opposite order is the reversal: between co-located antennas it is the same.
std::complex<double> field_of(const DoubleBounces& echoes) {
  const std::complex<double> there = coherent_sum(echoes.forward);
  EXPECT_LT(std::abs(there - coherent_sum(echoes.backward)), 1e-9 * std::abs(there));
  return there;
}

TEST(CurvedBounce, SphereThenPlateHasItsLevel) {
  const std::tuple<Vec3, double, Vec3, double> table[] = {{{5, 0, 0}, 0.1, {4.3, 1, .1}, -133.24},
                                                          {{5, 0, 0}, 0.1, {5.3, .8, 0}, -128.66},
                                                          {{5, 0, 0}, 0.4, {5.3, .9, 0}, -117.43},
                                                          {{5, 0, 0}, 0.4, {4.3, 1, .1}, -119.31},
                                                          {{7, 0, 0}, 2.0, {4, 1.5, 0}, -115.42}};
  for (const auto& [centre, radius, plate, expected] : table) {
    const Scenery made = scenery(centre, radius, plate);
    const EmbreeScene geometry(made.scene, PosedScene(made.scene, 0.0), Vec3::Zero());
    EXPECT_NEAR(decibel(std::norm(field_of(double_bounces(made, geometry, false)))), expected, kLevelTolerance);

    // Metal turns the polarisation at both bounces; all of the power arrives in two crossed ones together.
    DoubleBounces polarized = double_bounces(made, geometry, true);
    field_of(polarized);
    const TransverseBasis basis = transverse_basis(plate.normalized());
    double power = 0.0;
    for (const Vec3& received : {basis.horizontal, basis.vertical}) {
      polarized.forward.radar.receivers[0].polarization = received;
      power += std::norm(coherent_sum(polarized.forward));
    }
    EXPECT_NEAR(decibel(power), expected, kLevelTolerance);
  }
}

}  // namespace
}  // namespace echopath::test_curved_bounce
