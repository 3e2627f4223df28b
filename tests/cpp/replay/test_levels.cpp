// Levels of canonical targets against physical optics, image theory and energy conservation (77 GHz).
#include <gtest/gtest.h>

#include "cpp/support/scenes.h"

namespace echopath::test_levels {
namespace {

using namespace testing;

constexpr double kFarRange = 2000.0;                                    // m: far field of targets up to 0.2 m
constexpr double kPlateTolerance = 0.1;                                 // dB, the promise for a plate at broadside
constexpr double kMainLobeTolerance = 0.3;                              // dB
constexpr double kDihedralTolerance = 0.15, kTrihedralTolerance = 0.2;  // dB
constexpr double kMirrorTolerance = 1e-6;                               // relative: single precision of the weight
constexpr double kSphereTolerance = 0.1, kCoarseSphereTolerance = 0.3;  // dB, by the edges of the mesh
constexpr double kLengthRounding = 1e-9;                                // m
const Vec3 kCentre(kFarRange, 0, 0);

double rcs_dbsm(const Paths& paths) { return decibel(rcs_of(std::norm(coherent_sum(paths)), kFarRange, 77e9)); }

Paths far_trace(const Scene& scene, int64_t num_rays, int max_bounces,
                PolarizationModel model = PolarizationModel::kScalar) {
  TraceSettings settings = with_rays(num_rays, max_bounces);
  settings.polarization = model;
  return trace(scene, plain_radar(Vec3::Zero(), Vec3::Zero()), settings);
}

Paths with_bounces(const Paths& paths, int count) {
  std::vector<uint8_t> keep;
  for (const uint8_t bounces : paths.num_bounces) keep.push_back(bounces == count);
  return paths.select(keep);
}

double plate_dbsm(double side, double angle_deg) {
  const double angle = angle_deg * kPi / 180.0;
  Scene scene;
  const Vec3 across(-std::sin(angle), std::cos(angle), 0.0), up = Vec3::UnitZ();
  add_rectangle(scene, "plate", kCentre - 0.5 * side * (across + up), side * across, side * up, share(Material::metal()));
  return rcs_dbsm(far_trace(scene, 1 << 16, 1));
}

TEST(Plate, BroadsideRcsIsThatOfPhysicalOptics) {
  EXPECT_NEAR(plate_dbsm(0.05, 0.0), 7.144, kPlateTolerance);
  EXPECT_NEAR(plate_dbsm(0.1, 0.0), 19.185, kPlateTolerance);
  EXPECT_NEAR(plate_dbsm(0.2, 0.0), 31.227, kPlateTolerance);
}

TEST(Plate, RcsOverAngleFollowsTheSincPattern) {
  EXPECT_NEAR(plate_dbsm(0.1, 0.5), 16.096, kMainLobeTolerance);
  const double bound = 0.05 * std::pow(10.0, 19.185 / 20);  // 0.05 of the main lobe's amplitude beyond the first null
  const std::pair<double, double> table[] = {{1.0, .277},   {2.0, -.183},    {3.0, -.980},
                                             {5.0, -3.833}, {10.0, -21.996}, {20.0, -16.400}};
  for (const auto& [angle_deg, expected] : table) {
    EXPECT_NEAR(std::pow(10.0, plate_dbsm(0.1, angle_deg) / 20), std::pow(10.0, expected / 20), bound) << angle_deg;
  }
}

TEST(Sphere, RcsIsItsGeometricCrossSection) {
  Scene scene;
  Surface surface = ellipsoid(kCentre, Vec3::Constant(0.1), 6);  // edges of 0.1 sqrt(a lambda)
  add_mesh(scene, "sphere", std::move(surface.vertices), std::move(surface.triangles), share(Material::metal()));
  EXPECT_NEAR(rcs_dbsm(far_trace(scene, 1 << 16, 1)), -15.03, kMainLobeTolerance);
}

// Second-order footprint and curved positions: rms error in dB over shifts of the rays and turns of the mesh.
double smooth_sphere_error_db(double radius, int subdivisions, int64_t num_rays) {
  constexpr int kTrials = 10;
  double sum = 0.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Quaternion turn(Eigen::AngleAxisd(0.7 * trial, Vec3(1, trial, 2).normalized()));
    Surface surface = ellipsoid(Vec3::Zero(), Vec3::Constant(radius), subdivisions);
    for (Vec3& vertex : surface.vertices) vertex = kCentre * radius / 0.1 + turn * vertex;
    Node node = node_with("sphere", std::move(surface), share(Material::metal()), true);
    Scene scene;
    scene.add(node);
    TraceSettings settings = with_rays(num_rays, 1);
    settings.seed = static_cast<uint64_t>(trial);
    const Paths paths = trace(scene, plain_radar(Vec3::Zero(), Vec3::Zero()), settings);
    const double rcs = rcs_of(std::norm(coherent_sum(paths)), kFarRange * radius / 0.1, 77e9);
    sum += std::pow(decibel(rcs / (kPi * radius * radius)), 2) / kTrials;
  }
  return std::sqrt(sum);
}

TEST(SmoothSphere, FewRaysGiveTheCrossSection) {
  EXPECT_LT(smooth_sphere_error_db(0.1, 5, 1 << 13), kSphereTolerance);        // ka = 161
  EXPECT_LT(smooth_sphere_error_db(2.0, 6, 1 << 13), kSphereTolerance);        // ka = 3228, edges of 0.4 sqrt(a lambda)
  EXPECT_LT(smooth_sphere_error_db(0.1, 3, 1 << 13), kCoarseSphereTolerance);  // edges of 0.76 sqrt(a lambda)
}

// Two squares of 0.1 m at right angles, the bisector toward the radar: 8 pi a^2 b^2 / lambda^2.
TEST(Dihedral, DoubleBounceIsThatOfTheCorner) {
  Scene scene;
  const double h = std::sqrt(0.5);
  const MaterialPtr metal = share(Material::metal());
  add_rectangle(scene, "left", kCentre - Vec3(0, 0, .05), Vec3(-.1 * h, .1 * h, 0), {0, 0, .1}, metal);
  add_rectangle(scene, "right", kCentre - Vec3(0, 0, .05), Vec3(-.1 * h, -.1 * h, 0), {0, 0, .1}, metal);
  EXPECT_NEAR(rcs_dbsm(with_bounces(far_trace(scene, 1 << 16, 2), 2)), 22.196, kDihedralTolerance);
}

// Three triangles of edge 0.1 m: 4 pi L^4 / (3 lambda^2).
TEST(Trihedral, TripleBounceIsThatOfTheCorner) {
  Scene scene;
  const Mat3 to_radar = Quaternion::FromTwoVectors(Vec3::Ones().normalized(), -Vec3::UnitX()).toRotationMatrix();
  const Vec3 a = kCentre + 0.1 * to_radar.col(0), b = kCentre + 0.1 * to_radar.col(1), c = kCentre + 0.1 * to_radar.col(2);
  add_mesh(scene, "corner", {kCentre, a, b, c}, {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}}, share(Material::metal()));
  for (const PolarizationModel model : {PolarizationModel::kScalar, PolarizationModel::kJones}) {
    EXPECT_NEAR(rcs_dbsm(with_bounces(far_trace(scene, 1 << 16, 3, model), 3)), 14.414, kTrihedralTolerance);
  }
}

TEST(Mirror, OnePlaneIsImageTheory) {
  Scene scene;
  add_rectangle(scene, "wall", {5, -50, -50}, {0, 100, 0}, {0, 0, 100}, share(Material::metal(true)));
  const Paths paths = far_trace(scene, 1000, 4);
  ASSERT_EQ(paths.num_paths(), 1);
  const Replayed replay = replayed(paths);
  const double wavelength = kSpeedOfLight / 77e9;
  EXPECT_NEAR(replay.lengths[0], 10.0, kLengthRounding);
  EXPECT_NEAR(std::abs(replay.amplitudes[0] + wavelength / (4 * kPi * 10.0)), 0.0, kMirrorTolerance * wavelength);
}

// Between co-located antennas both orders of a right-angled corner run through its edge and share one field.
TEST(Mirror, CornerOrdersShareTheField) {
  Scene scene;
  const MaterialPtr mirror = share(Material::metal(true));
  add_rectangle(scene, "wall", {4, -50, -3}, {0, 100, 0}, {0, 0, 50}, mirror);
  add_rectangle(scene, "floor", {-50, -50, -3}, {54, 0, 0}, {0, 100, 0}, mirror);
  const Paths paths = with_bounces(far_trace(scene, 1000, 4), 2);
  ASSERT_EQ(paths.num_paths(), 2);
  const Replayed replay = replayed(paths);
  const double expected = kSpeedOfLight / 77e9 / (4 * kPi * 10.0);
  EXPECT_NEAR(std::abs(replay.amplitudes[0] + replay.amplitudes[1]), expected, kMirrorTolerance * expected);
  EXPECT_NEAR(replay.lengths[0], 10.0, kLengthRounding);
}

// sigma = 4 rho A for a Lambert plate of reflectivity rho; 1.1985 m^2 at the finite range of 20 m. One trace is one speckle.
TEST(LambertPlate, MeanIsLambertAndSpeckleIsExponential) {
  Scene scene;
  add_rectangle(scene, "plate", {20, -.5, -.5}, {0, 1, 0}, {0, 0, 1}, lambert(0.3));
  const Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero());
  constexpr int kRealisations = 600;
  std::vector<double> looks;
  TraceSettings settings = with_rays(500, 1);
  double mean = 0.0;
  for (int i = 0; i < kRealisations; ++i) {
    settings.seed = static_cast<uint64_t>(i);
    looks.push_back(rcs_of(std::norm(coherent_sum(trace(scene, radar, settings))), 20.0, 77e9));
    mean += looks.back() / kRealisations;
  }
  double variance = 0.0;
  int above = 0;
  for (const double look : looks) {
    variance += (look - mean) * (look - mean) / (kRealisations - 1);
    above += look > mean ? 1 : 0;
  }
  // Standard errors at 600 looks: mean 4.1 %, std/mean 5.8 % (exponential: fourth moment), share 2 % absolute. The seeds are
  // fixed, so the bounds hold or not once and for all.
  EXPECT_NEAR(mean / 1.1985, 1.0, 0.05);
  EXPECT_NEAR(std::sqrt(variance) / mean, 1.0, 0.1);
  EXPECT_NEAR(above / double{kRealisations}, 0.3679, 0.05);
}

// The power that a rough facet sends through a sphere of receivers is the diffuse share of what falls on it.
TEST(Furnace, DiffusePowerIsConserved) {
  constexpr double kShare = 0.36, kReflectivity = 0.5, kRadius = 5.0;
  constexpr int kReceivers = 2000;
  Material material;
  material.reflectivity = kReflectivity;
  material.scattering = std::sqrt(kShare);
  Scene scene;
  const Vec3 centre(4, 1, 0.5);
  add_rectangle(scene, "facet", centre - Vec3(0, .05, .05), {0, .1, 0}, {0, 0, .1}, share(material));
  Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero());
  const Paths all = trace(scene, radar, with_rays(4000, 1));
  std::vector<uint8_t> is_diffuse;
  for (const uint64_t bits : all.diffuse) is_diffuse.push_back(bits != 0);
  const Paths paths = all.select(is_diffuse);

  radar.receivers.clear();
  for (int i = 0; i < kReceivers; ++i) {  // spherical Fibonacci points
    const double z = 1.0 - (2.0 * i + 1.0) / kReceivers, ring = std::sqrt(1.0 - z * z);
    const double turn = kTwoPi * i * 0.6180339887498949;
    radar.receivers.push_back(antenna_at(centre + kRadius * Vec3(z, ring * std::cos(turn), ring * std::sin(turn))));
  }
  std::vector<int64_t> indices(static_cast<size_t>(paths.num_paths()));
  for (size_t i = 0; i < indices.size(); ++i) indices[i] = static_cast<int64_t>(i);
  std::vector<double> lengths;
  std::vector<std::complex<double>> amplitudes;
  Replayer(paths, radar).evaluate(indices, paths.frame.trace_time, lengths, amplitudes);
  double received = 0.0;
  for (const std::complex<double>& amplitude : amplitudes) received += std::norm(amplitude);
  const double wavelength = kSpeedOfLight / 77e9;
  const double cell = 4 * kPi * kRadius * kRadius / kReceivers;
  const double scattered = received * cell / (wavelength * wavelength / (4 * kPi));
  const double cos_incidence = centre.normalized().x();
  const double incident = 0.01 * cos_incidence / (4 * kPi * centre.squaredNorm());  // small facet: solid angle A cos / r^2
  EXPECT_NEAR(scattered / (kShare * kReflectivity * incident), 1.0, 0.01);
}

}  // namespace
}  // namespace echopath::test_levels
