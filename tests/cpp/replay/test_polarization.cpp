// Polarised echoes: corners turned about the line of sight, and scalar and polarised traces beside each other.
#include <gtest/gtest.h>

#include "cpp/support/scenes.h"

namespace echopath::test_polarization {
namespace {

using namespace testing;

constexpr double kRange = 2000.0;          // m
constexpr double kCornerTolerance = 0.15;  // dB
constexpr double kModesTolerance = 0.1;    // dB
constexpr double kNull = -30.0;            // dB below full

struct Levels {
  double co, cross;  // dBsm
};

// Double bounce of a 0.1 m dihedral turned by `angle` about the line of sight; transmitted along `polarization`.
Levels dihedral(const Material& material, double angle, const Vec3& polarization, int bounces = 2,
                int64_t num_rays = 1 << 15) {
  const Mat3 turn = Eigen::AngleAxisd(angle, Vec3::UnitX()).toRotationMatrix();
  const double h = 0.1 * std::sqrt(0.5);
  const Vec3 centre(kRange, 0, 0), edge = turn * Vec3(0, 0, 0.1);
  const Vec3 left = turn * Vec3(-h, h, 0), right = turn * Vec3(-h, -h, 0);
  Scene scene;
  add_rectangle(scene, "left", centre - 0.5 * edge, left, edge, share(material));
  add_rectangle(scene, "right", centre - 0.5 * edge, right, edge, share(material));
  Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero());
  radar.transmitters[0].polarization = polarization;
  radar.receivers.push_back(radar.receivers[0]);
  radar.receivers[0].polarization = polarization;
  radar.receivers[1].polarization = Vec3::UnitX().cross(polarization);
  TraceSettings settings = with_rays(num_rays, 2);
  settings.polarization = PolarizationModel::kJones;
  const Paths all = trace(scene, radar, settings);
  std::vector<int64_t> kept;
  for (int64_t i = 0; i < all.num_paths(); ++i) {
    if (bounces == 0 || all.num_bounces[static_cast<size_t>(i)] == bounces) kept.push_back(i);
  }
  std::vector<double> lengths;
  std::vector<std::complex<double>> amplitudes;
  Replayer(all, radar).evaluate(kept, all.frame.trace_time, lengths, amplitudes);
  const double wavenumber = kTwoPi * 77e9 / kSpeedOfLight;
  std::complex<double> sums[2] = {0.0, 0.0};
  for (size_t i = 0; i < lengths.size(); ++i) {
    sums[i / kept.size()] += amplitudes[i] * std::polar(1.0, -std::fmod(wavenumber * lengths[i], kTwoPi));
  }
  return {decibel(rcs_of(std::norm(sums[0]), kRange, 77e9)), decibel(rcs_of(std::norm(sums[1]), kRange, 77e9))};
}

TEST(Polarization, MetalDihedralTurnsThePolarization) {
  const double full = 22.196;
  const Levels upright = dihedral(Material::metal(), 0.0, Vec3::UnitZ());
  EXPECT_NEAR(upright.co, full, kCornerTolerance);
  EXPECT_LT(upright.cross, full + kNull);
  const Levels half = dihedral(Material::metal(), kPi / 8, Vec3::UnitZ());
  EXPECT_NEAR(half.co, 19.185, kCornerTolerance);
  EXPECT_NEAR(half.cross, 19.185, kCornerTolerance);
  const Levels turned = dihedral(Material::metal(), kPi / 4, Vec3::UnitZ());
  EXPECT_LT(turned.co, full + kNull);
  EXPECT_NEAR(turned.cross, full, kCornerTolerance);
}

TEST(Polarization, SingleBouncesOfTheTurnedDihedralRemain) {
  // With all bounces the co-polar null is filled by the single ones, far side lobes of both faces: -20.3 dBsm. Their edges
  // are what is sampled, hence many rays and a wide bound.
  EXPECT_NEAR(dihedral(Material::metal(), kPi / 4, Vec3::UnitZ(), 0, 1 << 19).co, -20.3, 0.5);
}

TEST(Polarization, DielectricDihedralHasFresnelLevels) {
  Material dielectric;
  dielectric.permittivity = std::complex<double>(4.0, -0.2);
  EXPECT_NEAR(dihedral(dielectric, 0.0, Vec3::UnitZ()).co, 8.400, kModesTolerance);   // VV: TE at both faces
  EXPECT_NEAR(dihedral(dielectric, 0.0, Vec3::UnitY()).co, -5.396, kModesTolerance);  // HH: TM
  const Levels turned = dihedral(dielectric, kPi / 4, Vec3::UnitZ());
  EXPECT_NEAR(turned.co, 0.398, kModesTolerance);
  EXPECT_NEAR(turned.cross, 3.992, kModesTolerance);
}

// Plates and mirrors seen along their normal have no plane of incidence: scalar and polarised agree.
TEST(Polarization, ModelsAgreeAtNormalIncidence) {
  for (const bool mirror : {false, true}) {
    Scene scene;
    add_rectangle(scene, "plate", {50, -.05, -.05}, {0, .1, 0}, {0, 0, .1}, share(Material::metal(mirror)));
    std::complex<double> sums[2];
    for (const PolarizationModel model : {PolarizationModel::kScalar, PolarizationModel::kJones}) {
      TraceSettings settings = with_rays(5000);
      settings.polarization = model;
      sums[static_cast<int>(model)] = coherent_sum(trace(scene, plain_radar(Vec3::Zero(), Vec3::Zero()), settings));
    }
    EXPECT_LT(std::abs(sums[0] - sums[1]), 1e-5 * std::abs(sums[0]));
  }
}

// Rays about the normal meet both modes, whose coefficients differ in sign there: the echo is Fresnel's all the same.
TEST(Polarization, DielectricPlateReflectsWithFresnelsCoefficientInBothModels) {
  const auto earth = std::make_shared<Material>();
  earth->permittivity = std::complex<double>(4.0, 0.0);
  for (const PolarizationModel model : {PolarizationModel::kScalar, PolarizationModel::kJones}) {
    std::complex<double> sums[2];
    for (const bool metal : {false, true}) {
      Scene scene;
      add_rectangle(scene, "plate", {50, -.05, -.05}, {0, .1, 0}, {0, 0, .1}, metal ? share(Material::metal()) : earth);
      TraceSettings settings = with_rays(5000);
      settings.polarization = model;
      sums[metal] = coherent_sum(trace(scene, plain_radar(Vec3::Zero(), Vec3::Zero()), settings));
    }
    EXPECT_NEAR(std::abs(sums[0] / sums[1] - 1.0 / 3.0), 0.0, 1e-5);  // (1 - 2) / (1 + 2) over -1
  }
}

TEST(Polarization, ScalarTraceKeepsNoMatrix) {
  Scene scene;
  add_rectangle(scene, "plate", {50, -.05, -.05}, {0, .1, 0}, {0, 0, .1}, share(Material::metal()));
  TraceSettings settings = with_rays(1000);
  EXPECT_TRUE(trace(scene, plain_radar(Vec3::Zero(), Vec3::Zero()), settings).jones.empty());
}

}  // namespace
}  // namespace echopath::test_polarization
