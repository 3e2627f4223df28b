// Replay leaves out paths that no sum of doubles would show, and poses only the meshes that paths touch.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "cpp/replay/small_arrays.h"
#include "cpp/support/scenes.h"
#include "echopath/replay/posed/touched_meshes.h"
#include "echopath/replay/replay.h"

namespace echopath::test_interpolated_paths {
namespace {

using namespace testing;

constexpr double kRounding = std::numeric_limits<double>::epsilon();

// Metal balls that turn: their launch cells filter all but the glints away.
Paths record(const Radar& radar) {
  Scene scene;
  for (const double side : {-1.0, 1.0}) {
    Surface surface = ellipsoid(Vec3::Zero(), {.3, .2, .25}, 3);
    Node node = node_with(side < 0 ? "left" : "right", std::move(surface),
                          std::make_shared<const Material>(Material::metal()), true);
    node.placement = Eigen::Translation3d(8, side, 0) * Transform::Identity();
    node.motion = std::make_shared<LinearMotion>(Vec3(-3, 0, 0), Vec3(0, 0, 2 * side));
    scene.add(node);
  }
  return trace(scene, radar, with_rays(2000, 1));
}

// Returns the largest amplitude of each path over the frame and all channels.
std::vector<double> largest(const Paths& paths, const Radar& radar, const Replayer& replayer) {
  constexpr int kTimes = 60;
  const std::vector<int64_t> indices = all_of(paths);
  std::vector<double> most(indices.size()), lengths;
  std::vector<std::complex<double>> amplitudes;
  for (int i = 0; i <= kTimes; ++i) {
    replayer.evaluate(indices, paths.frame.start_time + radar.frame_duration() * i / kTimes, lengths, amplitudes);
    for (size_t at = 0; at < amplitudes.size(); ++at) {
      double& of_path = most[at % indices.size()];
      of_path = std::max(of_path, std::abs(amplitudes[at]));
    }
  }
  return most;
}

// Replays to a radar the paths that another one has traced.
void expect_little_left_out(const Paths& paths, const Radar& radar, int64_t least) {
  Replayer replayer(paths, radar);
  const GridIndex polynomial = replayer.path_grids().first(0);
  replayer.pose_polynomial(polynomial, all_of(paths));
  std::vector<UnfollowedPath> before, left;
  replayer.interpolated(all_of(paths), polynomial, before);
  for (const UnfollowedPath& path : before) EXPECT_FALSE(path.is_negligible);
  replayer.find_strongest();
  const std::vector<Echoes> echoes = replayer.interpolated(all_of(paths), polynomial, left);
  const std::vector<double> most = largest(paths, radar, replayer);
  const double strongest = *std::max_element(most.begin(), most.end());
  double sum = 0.0;
  int64_t num_negligible = 0;
  for (const UnfollowedPath& path : left) {
    if (!path.is_negligible) continue;
    sum += most[static_cast<size_t>(path.path)];
    ++num_negligible;
  }
  EXPECT_GT(num_negligible, least);
  EXPECT_LE(sum, kRounding * strongest);
  EXPECT_EQ(echoes.front().num_echoes + std::ssize(left), paths.num_paths());
}

TEST(InterpolatedPaths, ThoseThatAreLeftOutAreTogetherBelowTheRoundingOfTheStrongest) {
  const Paths paths = record(two_by_two());
  expect_little_left_out(paths, two_by_two(), paths.num_paths() / 4);
}

// The first antennas hardly hear what the others do: these stand a metre away, look another way, are stronger and have
// another polarisation.
TEST(InterpolatedPaths, WhatIsDarkToTheFirstAntennasAloneIsNotLeftOut) {
  Radar radar = two_by_two();
  const Paths paths = record(radar);
  for (std::vector<Antenna>* antennas : {&radar.transmitters, &radar.receivers}) {
    antennas->front().pattern = AntennaPattern::cosine_power(6.0);
    antennas->front().orientation = turned(1.4, 0.0);
    antennas->back().position += Vec3(0, 1.0, 0.4);
    antennas->back().pattern = AntennaPattern::cosine_power(1.0);
    antennas->back().polarization = Vec3(0, 0.6, 0.8);
  }
  expect_little_left_out(paths, radar, paths.num_paths() / 20);
}

// Poses the whole scene, and one transmitter, at the nodes of samples of its chirps.
PosedGrid whole_scene(const Paths& paths, const Radar& radar, const TimeGrids& grids, int transmitter) {
  FrameNodes nodes = nodes_of(grids.samples(transmitter), radar, grids.start_time(), grids.derivatives());
  const MeshesToPose all{*paths.scene, whole_meshes(*paths.scene).places, touched_meshes(paths).patches};
  auto scenes = pose_at(*paths.scene, radar, all, paths.frame.transmitter, nodes.times);
  for (PosedScene& scene : *scenes) scene.transmitters = {scene.transmitters[static_cast<size_t>(transmitter)]};
  return {std::move(nodes), PosedNodes(std::move(scenes)), transmitter};
}

TEST(InterpolatedPaths, MeshesThatArePosedLaterStandWhereAllWouldStand) {
  const Radar radar = two_by_two();
  const Paths paths = record(radar);
  const Replayer replayer(paths, radar);
  const std::vector<int64_t> indices = all_of(paths);
  ASSERT_EQ(replayer.meshes_of(indices), (std::vector<uint32_t>{0, 1}));
  for (const int transmitter : {0, 1}) {
    PartlyPosedGrid partly = replayer.pose_partly(replayer.grids().samples(transmitter));
    for (const uint32_t mesh : {1u, 0u}) partly.with(std::span(&mesh, 1));
    EXPECT_GT(partly.num_bytes(), 0);
    const std::vector<Echoes> expected = replayer.exact(indices, whole_scene(paths, radar, replayer.grids(), transmitter));
    const std::vector<Echoes> found = replayer.exact(indices, partly.with({}));
    for (size_t channel = 0; channel < found.size(); ++channel) {
      EXPECT_EQ(found[channel].delay, expected[channel].delay);
      EXPECT_EQ(found[channel].amplitude, expected[channel].amplitude);
    }
  }
}

TEST(InterpolatedPaths, PolynomialsMustBePosed) {
  const Radar radar = two_by_two();
  const Paths paths = record(radar);
  const Replayer replayer(paths, radar);
  std::vector<UnfollowedPath> left;
  EXPECT_THROW(replayer.interpolated(all_of(paths), GridIndex::polynomial(0), left), std::invalid_argument);
}

TEST(InterpolatedPaths, PolynomialsPosedForSomePathsGiveThemTheSameEchoes) {
  const Radar radar = two_by_two();
  const Paths paths = record(radar);
  Replayer whole(paths, radar), partly(paths, radar);
  std::vector<std::vector<int64_t>> of_mesh(2);
  for (const int64_t path : all_of(paths)) of_mesh[paths.hits_of(path)->mesh_id].push_back(path);
  const GridIndex polynomial =
      GridIndex::polynomial(whole.grids().num_polynomials(MotionCuts::kOfRadar) - 1);  // where no motion was tried
  whole.pose_polynomial(polynomial, all_of(paths));
  for (const std::vector<int64_t>& some : {of_mesh[1], of_mesh[0]}) {
    ASSERT_FALSE(some.empty());
    partly.pose_polynomial(polynomial, some);
    std::vector<UnfollowedPath> left, expected_left;
    const std::vector<Echoes> expected = whole.interpolated(some, polynomial, expected_left);
    const std::vector<Echoes> found = partly.interpolated(some, polynomial, left);
    ASSERT_GT(found.front().num_echoes, 0);
    for (size_t channel = 0; channel < found.size(); ++channel) {
      EXPECT_EQ(found[channel].delay, expected[channel].delay);
      EXPECT_EQ(found[channel].amplitude, expected[channel].amplitude);
    }
  }
}

}  // namespace
}  // namespace echopath::test_interpolated_paths
