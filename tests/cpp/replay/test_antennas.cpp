// Antenna tables in the amplitudes of paths: direction, orientation, and a phase with the right sign.
#include <gtest/gtest.h>

#include <functional>

#include "cpp/support/scenes.h"

namespace echopath::test_antennas {
namespace {

using namespace testing;

constexpr double kInterpolation = 2e-3;   // relative: tables in steps of 2 degrees, amplitudes of gains that fall to 0
constexpr double kPhaseTolerance = 1e-3;  // rad, the same for phases of up to 1.6 rad
constexpr double kWavenumber = kTwoPi * 77e9 / kSpeedOfLight;
constexpr double kRounding = 1e-12;

using OverDirection = std::function<double(const Vec3&)>;

AntennaPattern table(const OverDirection& gain, const OverDirection& phase, int last_azimuth_deg) {
  std::vector<double> azimuth, elevation, gains, phases;
  for (int deg = -last_azimuth_deg; deg <= last_azimuth_deg; deg += 2) azimuth.push_back(deg * kPi / 180);
  for (int deg = -90; deg <= 90; deg += 2) elevation.push_back(deg * kPi / 180);
  for (const double e : elevation) {
    for (const double a : azimuth) {
      const Vec3 u(std::cos(a) * std::cos(e), std::sin(a) * std::cos(e), std::sin(e));
      gains.push_back(gain(u));
      if (phase) phases.push_back(phase(u));
    }
  }
  return AntennaPattern::of_table(GainTable(azimuth, elevation, gains, phases));
}

double lopsided(const Vec3& u) { return std::pow(0.5 + 0.2 * u.x() + 0.15 * u.y() - 0.1 * u.z(), 2); }
double even(const Vec3&) { return 0.9; }

// Small rough squares all around; rays to each.
Paths paths_around(const Radar& radar, int max_bounces = 1) {
  Scene scene;
  const Vec3 centres[] = {{10, 0, 0}, {6, 7, 2}, {5, -4, 3}, {-8, 2, -3}, {1, 2, -9}};
  int index = 0;
  for (const Vec3& centre : centres) {
    const Vec3 across = centre.unitOrthogonal() * 0.1, up = centre.cross(across).normalized() * 0.1;
    add_rectangle(scene, "square" + std::to_string(index++), centre - 0.5 * (across + up), across, up, lambert(0.5));
  }
  return trace(scene, radar, with_rays(2000, max_bounces));
}

Vec3 point_of(const Paths& paths, int64_t path) {
  const Hit& hit = paths.hits_of(path)[0];
  const auto [a, b, c] = PosedScene(*paths.scene, 0.0).world_triangle(hit.mesh_id, hit.triangle_id);
  return a + double{hit.u} * (b - a) + double{hit.v} * (c - a);
}

TEST(AntennaTable, GainIsThatOfTheDirectionInTheAntennasAxes) {
  const Quaternion turned(Eigen::AngleAxisd(1.1, Vec3(0.3, -0.5, 0.8).normalized()));
  Paths paths = paths_around(plain_radar(Vec3::Zero(), Vec3::Zero()));
  ASSERT_GT(paths.num_paths(), 100);
  const Replayed plain = replayed(paths);
  for (const bool transmit : {true, false}) {
    Antenna& antenna = transmit ? paths.radar.transmitters[0] : paths.radar.receivers[0];
    const Antenna isotropic = antenna;
    antenna.orientation = turned;
    antenna.pattern = table(lopsided, nullptr, 180);
    const Replayed seen = replayed(paths);
    for (int64_t p = 0; p < paths.num_paths(); ++p) {
      const Vec3 direction = turned.inverse() * point_of(paths, p).normalized();
      const auto i = static_cast<size_t>(p);
      const std::complex<double> ratio = seen.amplitudes[i] / plain.amplitudes[i];
      EXPECT_NEAR(std::abs(ratio - std::sqrt(lopsided(direction))), 0.0, kInterpolation);
    }
    antenna = isotropic;
  }
}

TEST(AntennaTable, SampledCosineIsTheCosine) {
  Paths paths = paths_around(plain_radar(Vec3::Zero(), Vec3::Zero()));
  Antenna& antenna = paths.radar.transmitters[0];
  antenna.orientation = Quaternion(Eigen::AngleAxisd(0.6, Vec3::UnitZ()));
  antenna.pattern = AntennaPattern::cosine_power(4.0);
  const Replayed closed = replayed(paths);
  antenna.pattern = table([](const Vec3& u) { return 10.0 * std::pow(std::max(0.0, u.x()), 4); }, nullptr, 90);
  const Replayed sampled = replayed(paths);
  double largest = 0.0;
  for (const std::complex<double>& a : closed.amplitudes) largest = std::max(largest, std::abs(a));
  ASSERT_GT(largest, 0.0);
  for (size_t i = 0; i < closed.amplitudes.size(); ++i) {
    EXPECT_NEAR(std::abs(sampled.amplitudes[i] - closed.amplitudes[i]), 0.0, kInterpolation * largest);
  }
}

// An element at d radiates e^{+jk d.u} more than one at the origin: far away, phase and position must be the same.
TEST(AntennaTable, PhaseOfADisplacementIsTheDisplacement) {
  const Vec3 offset(0.0003, 0.0007, -0.0005);
  Paths paths = paths_around(plain_radar(Vec3::Zero(), Vec3::Zero()));
  const auto phase = [&](const Vec3& u) { return kWavenumber * offset.dot(u); };
  for (const bool transmit : {true, false}) {
    Antenna& antenna = transmit ? paths.radar.transmitters[0] : paths.radar.receivers[0];
    const Antenna centred = antenna;
    antenna.pattern = AntennaPattern::isotropic(0.9);
    antenna.position = offset;
    const Replayed moved = replayed(paths);
    antenna.position = Vec3::Zero();
    antenna.pattern = table(even, phase, 180);
    const Replayed turned = replayed(paths);
    for (size_t i = 0; i < moved.lengths.size(); ++i) {
      const double expected = std::arg(moved.amplitudes[i]) - kWavenumber * moved.lengths[i];
      const double got = std::arg(turned.amplitudes[i]) - kWavenumber * turned.lengths[i];
      EXPECT_NEAR(std::remainder(got - expected, kTwoPi), 0.0, kPhaseTolerance);
    }
    antenna = centred;
  }
}

TEST(AntennaTable, PathsOverMirrorsAloneHaveThePhasesOfBothAntennas) {
  Scene scene;
  add_rectangle(scene, "wall", Vec3(-5, 3, -5), Vec3(20, 0, 0), Vec3(0, 0, 10), share(Material::metal(true)));
  TraceSettings settings = with_rays(100);
  Paths paths = trace(scene, plain_radar(Vec3::Zero(), Vec3(4, 0, 0)), settings);
  ASSERT_EQ(paths.num_paths(), 1);
  const std::complex<double> plain = replayed(paths).amplitudes[0];
  paths.radar.transmitters[0].pattern = table(even, [](const Vec3&) { return 0.4; }, 180);
  paths.radar.receivers[0].pattern = table(even, [](const Vec3&) { return 0.3; }, 180);
  EXPECT_NEAR(std::abs(replayed(paths).amplitudes[0] / plain - std::polar(0.9, 0.7)), 0.0, kPhaseTolerance);
}

// Receivers count where there may be several bounces: a way that reaches one from behind is traced from its other end.
TEST(AntennaTable, RaysFillTheHalfSpaceWhereNoAntennaHasGainBehind) {
  Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero());
  Antenna &transmitter = radar.transmitters[0], &receiver = radar.receivers[0];
  const auto field_of_view = [&](int max_bounces) { return paths_around(radar, max_bounces).frame.strata.back(); };
  for (const int max_bounces : {1, 2}) EXPECT_EQ(field_of_view(max_bounces).versine, 2.0);
  transmitter.orientation = receiver.orientation = Quaternion(Eigen::AngleAxisd(0.6, Vec3::UnitZ()));
  transmitter.pattern = table(even, nullptr, 90);
  EXPECT_EQ(field_of_view(1).versine, 1.0);
  EXPECT_EQ(field_of_view(2).versine, 2.0);
  receiver.pattern = table(even, nullptr, 90);
  EXPECT_EQ(field_of_view(2).versine, 1.0);
  EXPECT_NEAR((field_of_view(2).axis - Vec3(std::cos(0.6), std::sin(0.6), 0)).norm(), 0.0, kRounding);
  receiver.pattern = table(even, nullptr, 92);
  EXPECT_EQ(field_of_view(2).versine, 2.0);
  transmitter.pattern = table(even, nullptr, 92);
  EXPECT_EQ(field_of_view(1).versine, 2.0);
}

}  // namespace
}  // namespace echopath::test_antennas
