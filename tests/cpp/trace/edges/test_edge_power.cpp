// What edges carry by estimate, and which of them a trace leaves out.
#include <gtest/gtest.h>

#include <cmath>

#include "cpp/support/scenes.h"
#include "echopath/radar/noise_power.h"
#include "echopath/trace/edges/edge_power.h"

namespace echopath::test_edge_power {
namespace {

using namespace testing;

constexpr double kZone = 0.05;  // of the power: that of an edge's Fresnel zone for that of the whole edge
constexpr double kRounding = 1e-12;

MaterialPtr metal_of_edges() {
  Material material;
  material.conductor = true;
  return share(material);
}

// A metal strip whose long edges stand upright across the line of sight, at a distance.
Scene strip_at(double distance) {
  Scene scene;
  add_rectangle(scene, "strip", {distance, -0.2, -2}, {0.1, 0.4, 0}, {0, 0, 4}, metal_of_edges());
  return scene;
}

double estimated(double distance, double gain = 1.0) {
  return strongest_edge(strip_at(distance), plain_radar(Vec3::Zero(), Vec3::Zero(), gain), 0.0);
}

// An edge longer than its Fresnel zone: the field goes as the zone, sqrt(r), over r^2.
TEST(EdgePower, ALongEdgeFallsWithTheCubeOfTheDistance) { EXPECT_NEAR(estimated(10.0) / estimated(20.0), 8.0, 8.0 * kZone); }

TEST(EdgePower, GainsOfBothAntennasMultiply) { EXPECT_NEAR(estimated(10.0, 0.5) / estimated(10.0), 0.25, 1e-9); }

// An upright edge couples nothing across itself and most along itself: the pair that it couples most decides.
TEST(EdgePower, DoesNotDependOnTheOrderOfTheAntennas) {
  Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero());
  radar.receivers.push_back(radar.receivers[0]);
  radar.receivers[1].polarization = Vec3::UnitY();
  const double upright_first = strongest_edge(strip_at(10.0), radar, 0.0);
  std::swap(radar.receivers[0], radar.receivers[1]);
  EXPECT_NEAR(strongest_edge(strip_at(10.0), radar, 0.0) / upright_first, 1.0, kRounding);
  EXPECT_NEAR(estimated(10.0) / upright_first, 1.0, kRounding);
}

TEST(EdgePower, SeveralEdgesInARowSendNoMoreThanOneThatIsNotCutOff) {
  const Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero());
  const EdgeEstimate estimate(radar, Transform::Identity(), Vec3::Zero());
  const Scene scene = strip_at(10.0);
  for (const PosedEdge& edge : posed_edges(scene, PosedScene(scene, 0.0), Vec3::Zero())) {
    const Vec3 middle = 0.5 * (edge.from + edge.to), direction = middle.normalized();
    const EdgeLeg leg{-direction, direction, middle.norm()};
    EXPECT_LE(estimate.power(edge.wedge, leg, leg, 1.0, 0.01), estimate.power(edge.wedge, leg, leg, 1.0));
  }
}

// The field spreads over both ways, and the zone of stationary phase goes as the root of r s / (r + s): 1 / (r s (r + s)).
TEST(EdgePower, ALongEdgeBetweenTwoPlacesFallsWithBothWaysAndTheirSum) {
  const Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero());
  const EdgeEstimate estimate(radar, Transform::Identity(), Vec3::Zero());
  const Scene scene = strip_at(10.0);
  const Wedge wedge = posed_edges(scene, PosedScene(scene, 0.0), Vec3::Zero()).front().wedge;
  const Vec3 axis = axis_of(wedge), across = axis.unitOrthogonal();
  // On Keller's cone the phase stands at any slant: there and back the ways have opposite slopes.
  const auto power = [&](double slope, double there, double back) {
    const Vec3 in = (across + slope * axis).normalized(), out = (across - slope * axis).normalized();
    return estimate.power(wedge, {in, -in, there}, {out, -out, back}, 1.0);
  };
  EXPECT_NEAR(power(0.0, 10.0, 20.0) / power(0.0, 10.0, 10.0), 2000.0 / 6000.0, kRounding);
  EXPECT_NEAR(power(0.7, 10.0, 20.0) / power(0.0, 10.0, 20.0), 1.0, kRounding);
}

TEST(EdgePower, NothingIsLeftOutWhereNoEdgeStandsOutOfTheNoise) {
  const Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero());
  const double noise = noise_power_in_cell(radar);
  EXPECT_EQ(least_edge_power(0.5 * noise, radar), 0.0);
  EXPECT_NEAR(least_edge_power(2.0 * noise, radar) / noise, 1e-4, kRounding);
}

// The sum of what is left out lies far below the noise, and below it nothing else is left out.
TEST(EdgePower, ATraceKeepsWhatStandsOutOfTheNoise) {
  Scene scene = strip_at(5.0);
  for (int i = 0; i < 40; ++i)
    add_rectangle(scene, "far" + std::to_string(i), Vec3(600.0 + 10.0 * i, 100.0 + 0.4 * i, -1), {0.02, 0.01, 0},
                  {0, 0, 0.01}, metal_of_edges());
  TraceSettings settings = with_rays(100, 1);
  settings.edges = true;
  const auto traced = [&](double noise_figure_db) {
    Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero());
    radar.noise_figure_db = noise_figure_db;
    return trace(scene, radar, settings);
  };
  const auto edges_of = [](const Paths& paths) {
    double left = 0.0;
    int count = 0;
    const Replayed echoes = replayed(paths);
    for (size_t path = 0; path < echoes.amplitudes.size(); ++path) {
      if (edge_hit(paths.flags[path]) < 0) continue;
      ++count;
      left += std::norm(echoes.amplitudes[path]);
    }
    return std::pair(count, left);
  };
  const Radar quiet = plain_radar(Vec3::Zero(), Vec3::Zero());
  Radar radar = quiet;
  const double least_noise = noise_power_in_cell(quiet) * std::pow(10.0, -0.1 * quiet.noise_figure_db);
  radar.noise_figure_db = 10.0 * std::log10(0.5 * strongest_edge(scene, quiet, 0.0) / least_noise);
  const auto [all, power_of_all] = edges_of(traced(300.0));  // no edge stands out of such a noise
  const auto [kept, power_of_kept] = edges_of(traced(radar.noise_figure_db));
  EXPECT_LT(kept, all);
  EXPECT_GT(kept, 0);
  EXPECT_LT(power_of_all - power_of_kept, 1e-2 * noise_power_in_cell(radar));
}

}  // namespace
}  // namespace echopath::test_edge_power
