// How rays go on must not show in the echo: Russian roulette and the choice between specular and diffuse.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>

#include "cpp/support/sanitized.h"
#include "cpp/support/scenes.h"
#include "echopath/power/received_power.h"
#include "echopath/record/blocks/record_writer.h"
#include "echopath/trace/sbr/sbr.h"

namespace echopath::test_weight_rules {
namespace {

using namespace testing;

constexpr double kSphereTolerance = 0.005;  // relative
constexpr double kDihedralTolerance = 0.2;  // dB, of the mean of 32 seeds
constexpr double kSinglePrecision = 1e-6;   // relative, of the weights in a record
constexpr int kSeeds = 32;
constexpr double kHemisphereTolerance = 0.01;   // relative: three standard errors and 0.2 % of facets
constexpr double kEnhancementTolerance = 0.05;  // three standard deviations over seeds, by interference of different legs

// Integrating sphere of radius 3 m with Lambert walls: lambda^2 rho / (4 pi^2 R^2 (1 - rho)) of the transmitted power
// arrives at any point inside. Most of it after the bounce from which rays go on by roulette.
TEST(WeightRules, IntegratingSphere) {
  for (const auto& [reflectivity, truth] : std::vector<std::pair<double, double>>{{0.3, 1.8285e-8}, {0.7, 9.955e-8}}) {
    Scene scene;
    Surface wall = ellipsoid(Vec3::Zero(), {3, 3, 3}, 4);
    add_mesh(scene, "wall", std::move(wall.vertices), std::move(wall.triangles), lambert(reflectivity));
    TraceSettings settings = with_rays(100000, 60);
    settings.batches = 8;
    const Paths paths = trace(scene, plain_radar(Vec3::Zero(), {0.7, 0.4, -0.3}), settings);
    const ReceivedPower power = received_power(paths);
    EXPECT_NEAR(power.power / truth, 1.0, kSphereTolerance) << reflectivity;
    EXPECT_LT(power.standard_error / truth, kSphereTolerance) << reflectivity;
    // Reversals aside, one path a bounce: three, and as many as the roulette lets happen.
    const auto num_bounces =
        std::count_if(paths.flags.begin(), paths.flags.end(), [](uint32_t flags) { return (flags & kReversedPath) == 0; });
    EXPECT_LT(num_bounces, static_cast<int64_t>(100000 * (3.2 + 1.0 / (1.0 - reflectivity)))) << reflectivity;
  }
}

// Metal mirrors through the middle make two or four sources of one: as many times lambda^2 rho^n / (4 pi^2 R^2) arrive after
// n >= 2 diffuse bounces, wherever the antennas are before them, over all legs of the antennas and between the bounces
// together. Between antennas at one place both orders of every chain add as fields.
void expect_powers_of_chains(int num_mirrors) {
  constexpr double kReflectivity = 0.7, kRadius = 3.0;
  Scene scene;
  Surface wall = ellipsoid(Vec3::Zero(), Vec3::Constant(kRadius), 4);
  add_mesh(scene, "wall", std::move(wall.vertices), std::move(wall.triangles), lambert(kReflectivity));
  add_rectangle(scene, "floor", {-4, -4, 0}, {8, 0, 0}, {0, 8, 0}, share(Material::metal(true)));
  if (num_mirrors > 1) add_rectangle(scene, "side", {0, -4, -4}, {0, 8, 0}, {0, 0, 8}, share(Material::metal(true)));
  TraceSettings settings = with_rays(40000, 20);
  settings.batches = 16;
  const Paths paths = trace(scene, plain_radar({0.5, 0.3, 0.8}, {0.5, 0.3, 0.8}), settings);
  const Replayed replay = replayed(paths);
  std::array<double, 6> powers{};
  for (size_t i = 0; i < paths.offsets.size(); ++i) {
    const int count = std::popcount(paths.diffuse[i]);
    if (count < 6) powers[static_cast<size_t>(count)] += std::norm(replay.amplitudes[i]);
  }
  const double source = std::ldexp(1.0, num_mirrors) * std::pow(kSpeedOfLight / 77e9 / (kTwoPi * kRadius), 2);
  for (int count = 2; count < 6; ++count) {
    const double truth = source * std::pow(kReflectivity, count);
    std::vector<uint8_t> keep;
    for (const uint64_t bits : paths.diffuse) keep.push_back(std::popcount(bits) == count);
    const ReceivedPower power = received_power(paths.select(keep));
    EXPECT_NEAR(powers[static_cast<size_t>(count)] / truth, 1.0, kHemisphereTolerance) << count;
    EXPECT_NEAR(power.power / truth, 2.0, kEnhancementTolerance) << count;
  }
}

TEST(WeightRules, IntegratingHemisphereOverAMirror) { expect_powers_of_chains(1); }

TEST(WeightRules, QuarterOfAnIntegratingSphereInACornerOfMirrors) { expect_powers_of_chains(2); }

// Two faces of 0.1 m at a right angle, seen along the bisector.
Scene dihedral(double scattering) {
  Material material;
  material.reflectivity = 1.0;
  material.scattering = scattering;
  Scene scene;
  const double depth = 0.1 / std::sqrt(2.0);
  add_rectangle(scene, "left", {10, 0, -0.05}, {-depth, depth, 0}, {0, 0, 0.1}, share(material));
  add_rectangle(scene, "right", {10, 0, -0.05}, {-depth, -depth, 0}, {0, 0, 0.1}, share(material));
  return scene;
}

// What `trace` does, with odds of going on specularly that no setting of it offers. Radar at the origin.
Paths trace_with_odds(const Scene& scene, double specular_probability, uint64_t seed) {
  Paths paths;
  paths.scene = std::make_shared<const Scene>(scene);
  paths.radar = plain_radar(Vec3::Zero(), Vec3::Zero());
  paths.frame.seed = seed;
  paths.frame.max_bounces = 2;
  const EmbreeScene geometry(scene, PosedScene(scene, 0.0), Vec3::Zero());
  LaunchSettings launch;
  launch.num_rays = 1 << 14;
  launch.seed = seed;
  const std::vector<Mirror> no_mirrors;
  const LaunchPlan plan = plan_launch(scene, geometry, no_mirrors, launch);
  paths.frame.strata = plan.strata;
  SbrSettings odds;
  odds.max_bounces = 2;
  odds.seed = seed;
  odds.specular_probability = specular_probability;
  const AntennaFrusta no_frusta;
  const RayShooter shooter(scene, geometry, no_mirrors, plan, odds, no_frusta);
  PathBlock block;
  shooter.shoot(0, plan.first_ray.back(), block);
  RecordWriter record(paths);
  record.append({&block});
  record.finish();
  return paths;
}

std::complex<double> double_bounce(double scattering, double specular_probability, uint64_t seed) {
  const Paths paths = trace_with_odds(dihedral(scattering), specular_probability, seed);
  std::vector<uint8_t> keep;
  for (size_t i = 0; i < paths.offsets.size(); ++i) keep.push_back(paths.num_bounces[i] == 2 && paths.diffuse[i] == 0);
  return coherent_sum(paths.select(keep));
}

// What a face mirrors is followed whatever chance does to what it scatters: a field that leaves 1/sqrt(2) at either face has
// no noise of its own.
TEST(WeightRules, HalfDiffuseDihedralHasHalfTheFieldOfASmoothOneForEachSeed) {
  for (uint64_t seed = 1; seed <= 3; ++seed) {
    const std::complex<double> ratio = double_bounce(std::sqrt(0.5), 0.0, seed) / double_bounce(0.0, 0.0, seed);
    EXPECT_NEAR(std::abs(ratio - 0.5), 0.0, kSinglePrecision) << seed;
  }
}

// Half of the power scattered at each face leaves the field 1/sqrt(2) per face: -6.02 dB, however the ray chose. The test
// above has the rays that choose nothing.
TEST(WeightRules, HalfDiffuseDihedralLosesSixDecibelsForAnyBranching) {
  if (test::kIsSanitized) GTEST_SKIP() << "statistics over many runs of code that the other rules run";
  const double smooth = std::norm(double_bounce(0.0, 0.0, 1));
  for (const double probability : {0.2, 0.3, 0.8}) {
    double power = 0.0;
    for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
      power += std::norm(double_bounce(std::sqrt(0.5), probability, seed)) / kSeeds;
    }
    EXPECT_NEAR(decibel(power / smooth), -6.0206, kDihedralTolerance) << probability;
  }
}

}  // namespace
}  // namespace echopath::test_weight_rules
