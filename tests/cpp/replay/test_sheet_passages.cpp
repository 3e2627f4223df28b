// What sheets, the air and lobes make of the amplitudes of paths, against closed forms.
#include <gtest/gtest.h>

#include "cpp/support/scenes.h"
#include "echopath/replay/factors/path_passages.h"
#include "echopath/replay/posed/touched_meshes.h"

namespace echopath::test_sheet_passages {
namespace {

using namespace testing;
using Complex = std::complex<double>;

constexpr double kFrequency = 77e9, kWavenumber = kTwoPi * kFrequency / kSpeedOfLight;
constexpr double kThickness = 0.004;  // m
const Complex kPermittivity(6.3, -0.3);
constexpr double kSingle = 1e-6;  // single precision of weights
constexpr double kTable = 1e-6;   // of the tables of passages
constexpr double kAngles = 0.02;  // of the field: directions differ over the target
constexpr double kFacets = 2e-3;  // of the field: interpolated normals of a ball of 1280 triangles

MaterialPtr glass() {
  Material material;
  material.layers = {{kThickness, kPermittivity}};
  return share(material);
}

// Airy 1833: the series over the bounces within a slab, over free space between its faces.
struct Airy {
  Complex te, tm;

  explicit Airy(double cosine) {
    const Complex inside = std::sqrt(kPermittivity - (1.0 - cosine * cosine));
    const Complex through = std::exp(Complex(0.0, -kWavenumber * kThickness) * inside);
    const Complex free = std::polar(1.0, kWavenumber * kThickness * cosine);
    const auto passed = [&](Complex face) {
      return (1.0 - face * face) * through / (1.0 - face * face * through * through) * free;
    };
    te = passed((cosine - inside) / (cosine + inside));
    tm = passed((kPermittivity * cosine - inside) / (kPermittivity * cosine + inside));
  }
};

// A small square at (8, 0, 0), and a pane before it that is turned about the z-axis by an angle (rad).
Scene scene_behind(const MaterialPtr& pane, double angle, const MaterialPtr& target = lambert(0.5)) {
  Scene scene;
  add_rectangle(scene, "target", {8, -0.01, -0.01}, {0, 0.02, 0}, {0, 0, 0.02}, target);
  const Vec3 across(-3.0 * std::sin(angle), 3.0 * std::cos(angle), 0.0);
  if (pane) add_rectangle(scene, "pane", Vec3(4, 0, -3) - across, 2.0 * across, {0, 0, 6}, pane);
  return scene;
}

Paths traced(const Scene& scene, double attenuation = 0.0) {
  TraceSettings settings = with_rays(4000, 1);
  settings.attenuation = attenuation;
  return trace(scene, plain_radar(Vec3::Zero(), Vec3::Zero()), settings);
}

// The sum of the fields of the target's echoes.
Complex field_of_target(const Paths& paths) {
  const Replayed echoes = replayed(paths);
  Complex sum = 0.0;
  for (size_t path = 0; path < echoes.lengths.size(); ++path) {
    if (paths.hits_of(static_cast<int64_t>(path))->mesh_id == 0)
      sum += echoes.amplitudes[path] * std::polar(1.0, -kWavenumber * echoes.lengths[path]);
  }
  return sum;
}

TEST(SheetPassages, UprightWavesPassTwiceInTheModeAcrossThePlaneOfIncidence) {
  Material metal;
  metal.conductor = true;
  const Complex free = field_of_target(traced(scene_behind(nullptr, 0.0, share(metal))));
  for (const double angle : {0.0, 0.6, 1.1}) {
    const Complex passed = field_of_target(traced(scene_behind(glass(), angle, share(metal)))) / free;
    const Complex expected = Airy(std::cos(angle)).te * Airy(std::cos(angle)).te;
    EXPECT_LT(std::abs(passed / expected - 1.0), kAngles) << angle;
  }
}

TEST(PathPassages, FieldsPassBothModesByTheirOwnCoefficients) {
  const double angle = 0.9;
  const Paths paths = traced(scene_behind(glass(), angle));
  const PathPreparer preparer(paths, touched_meshes(paths));
  const RecordSheets sheets(preparer, paths.radar.waveform);
  int64_t path = 0;
  while (paths.hits_of(path)->mesh_id != 0) ++path;
  ASSERT_EQ(paths.passes_of(static_cast<size_t>(path)).size(), 2u);
  PathPassages passages(sheets, path);
  passages.pose(preparer.at_trace());
  const FieldVector upright(0.0, 0.0, 1.0), level(0.0, 1.0, 0.0);
  const FieldVector te = passages.through({0, Vec3::Zero(), true}, upright),
                    tm = passages.through({0, Vec3::Zero(), true}, level);
  EXPECT_LT(std::abs(te.z() / Airy(std::cos(angle)).te - 1.0), kAngles);
  EXPECT_LT(std::abs(tm.y() / Airy(std::cos(angle)).tm - 1.0), kAngles);
  const FieldVector back = passages.through({1, Vec3::Zero(), false}, level);  // the way back is the same way
  EXPECT_LT((back - tm).norm(), kTable);
}

// Over a mirror, the wave of an antenna that stands elsewhere than that of the trace goes straight to the image of the
// target.
TEST(PathPassages, OnTheWayToAMirrorDirectionsAreThoseToTheImage) {
  Material metal;
  metal.conductor = metal.mirror = true;
  Scene scene;
  add_rectangle(scene, "target", {8, -0.01, -0.01}, {0, 0.02, 0}, {0, 0, 0.02}, lambert(0.5));
  add_rectangle(scene, "floor", {-2, -5, -2}, {14, 0, 0}, {0, 10, 0}, share(metal));
  add_rectangle(scene, "pane", {2, -3, -3}, {0, 6, 0}, {0, 0, 6}, glass());
  const Paths paths = trace(scene, plain_radar(Vec3::Zero(), Vec3::Zero()), with_rays(4000, 2));
  const PathPreparer preparer(paths, touched_meshes(paths));
  const RecordSheets sheets(preparer, paths.radar.waveform);
  int64_t path = 0;
  while (paths.num_bounces[path] != 2 || paths.hits_of(path)[0].mesh_id != 1) ++path;
  PathPassages passages(sheets, path);
  passages.pose(preparer.at_trace());
  const Vec3 antenna(0, 0, 3), image(8, 0, -4);
  const FieldVector passed = passages.through({0, antenna, true}, FieldVector(0.0, 1.0, 0.0));
  EXPECT_LT(std::abs(passed.y() / Airy((image - antenna).normalized().x()).te - 1.0), kAngles);
}

// Waves from the centre of a smooth dome meet it upright everywhere.
TEST(PathPassages, SmoothSheetsHaveTheNormalOfThePlaceWhereALineCrossesThem) {
  Scene scene = scene_behind(nullptr, 0.0);
  scene.add(node_with("dome", ellipsoid(Vec3::Zero(), Vec3::Constant(4.0), 3), glass(), true));
  const Paths paths = traced(scene);
  const PathPreparer preparer(paths, touched_meshes(paths));
  const RecordSheets sheets(preparer, paths.radar.waveform);
  int64_t path = 0;
  while (paths.hits_of(path)->mesh_id != 0) ++path;
  PathPassages passages(sheets, path);
  passages.pose(preparer.at_trace());
  for (const Vec3& antenna : {Vec3(0, 0, 0), Vec3(0, 0.4, 0)}) {
    const double sine = (Vec3(8, 0, 0) - antenna).normalized().cross(antenna).norm() / 4.0;  // of the incidence
    const FieldVector passed = passages.through({0, antenna, true}, FieldVector(0.0, 0.0, 1.0));
    EXPECT_LT(std::abs(passed.z() / Airy(std::sqrt(1.0 - sine * sine)).te - 1.0), kFacets);
  }
}

TEST(Attenuation, WeakensBothWaysAlike) {
  const double attenuation = 0.02;  // Np/m
  const Complex through =
      field_of_target(traced(scene_behind(nullptr, 0), attenuation)) / field_of_target(traced(scene_behind(nullptr, 0)));
  EXPECT_NEAR(std::abs(through), std::exp(-attenuation * 16.0), kSingle + 1e-5);  // the target is not quite a point
  EXPECT_NEAR(std::arg(through), 0.0, kSingle);
}

// Degli-Esposti 2007, equation 7: ((1 + cos psi)/2)^a, at normal incidence with F = 4 pi (1 - 2^-(a+1))/(2 (a + 1)) by hand.
TEST(LobeFactors, AMonostaticEchoOfADirectiveLobeIsThatOfItsIntegral) {
  const auto power_of = [](int exponent) {
    Material material;
    material.reflectivity = 0.5;
    material.scattering = 1.0;
    material.lobe_exponent = exponent;
    Scene scene;
    add_rectangle(scene, "target", {8, -0.01, -0.01}, {0, 0.02, 0}, {0, 0, 0.02}, share(material));
    double power = 0.0;
    for (const Complex& amplitude : replayed(traced(scene)).amplitudes) power += std::norm(amplitude);
    return power;
  };
  for (const int exponent : {1, 4, 10}) {
    const double integral = 4.0 * kPi * (1.0 - std::pow(0.5, exponent + 1)) / (exponent + 1);
    EXPECT_NEAR(power_of(exponent) / power_of(0), (1.0 / integral) / (1.0 / kPi), 1e-3) << exponent;
  }
}

}  // namespace
}  // namespace echopath::test_sheet_passages
