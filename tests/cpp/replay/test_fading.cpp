// What turns away from the radar fades with the root of a cosine: its amplitude is that of each chirp, its length a
// polynomial.
#include <gtest/gtest.h>

#include <algorithm>

#include "cpp/replay/small_arrays.h"
#include "cpp/support/scenes.h"
#include "echopath/replay/replay.h"
#include "echopath/signal/echoes/echo_states.h"

namespace echopath::test_fading {
namespace {

using namespace testing;

constexpr double kPhaseTolerance = 2e-5;  // rad: the aim of 1e-5; tails are estimates
constexpr double kRounding = 1e-10;       // relative, of the same amplitude at another node
constexpr double kSlopeTolerance = 3e-6;  // m/s beside 120 m/s: differences over 2 us lack a third derivative of 5e6 m/s^3
constexpr double kGrazing = 5e-3;         // of a cosine: antennas 0.03 m apart, 8 m away, see it within 0.004 of each other

// A rotor: its sides come into view and leave it within a frame.
Paths record(const Radar& radar) {
  Scene scene;
  Surface surface = ellipsoid(Vec3::Zero(), {.3, .02, .02}, 2);
  Node node = node_with("rotor", std::move(surface), lambert(0.4));
  node.placement = Eigen::Translation3d(8, 0.5, 0) * Transform::Identity();
  node.motion = std::make_shared<LinearMotion>(Vec3::Zero(), Vec3(0, 0, 200));
  scene.add(node);
  return trace(scene, radar, with_rays(1000, 1));
}

// Paths whose lengths follow a polynomial and whose amplitudes do not.
std::vector<int64_t> fading(const Paths& paths, Replayer& replayer, GridIndex polynomial) {
  std::vector<int64_t> found;
  std::vector<UnfollowedPath> unfollowed;
  replayer.interpolated(all_of(paths), polynomial, unfollowed);
  const PathGrids path_grids = replayer.path_grids();
  for (const UnfollowedPath& one : unfollowed) {
    if (path_grids.next(one, polynomial).by_chirp) found.push_back(one.path);
  }
  return found;
}

// The rotor's paths, ready to be replayed, and the first polynomial over the frame.
struct RotorReplay {
  Radar radar = two_by_two();
  Paths paths = record(radar);
  Replayer replayer{paths, radar};
  PathGrids path_grids = replayer.path_grids();
  GridIndex polynomial = path_grids.first(0);
};

TEST(Fading, AmplitudesAreThoseOfTheChirps) {
  RotorReplay rotor;
  auto& [radar, paths, replayer, path_grids, polynomial] = rotor;
  replayer.pose_polynomial(polynomial, all_of(paths));
  const std::vector<int64_t> indices = fading(paths, replayer, polynomial);
  ASSERT_GT(indices.size(), 20u);
  std::vector<double> lengths, before, after;
  std::vector<std::complex<double>> amplitudes, ignored;
  EchoStates state;
  double darkest = 1.0, brightest = 0.0;
  for (const int transmitter : {0, 1}) {
    PartlyPosedGrid chirps = replayer.pose_partly(ChirpGrid{transmitter});
    const std::vector<Echoes> echoes = replayer.by_chirp(indices, polynomial, chirps.with(replayer.meshes_of(indices)));
    for (const int chirp : {0, 20, 63}) {
      const double time = paths.frame.start_time + radar.chirp_time(transmitter, chirp), step = 1e-6;
      replayer.evaluate(indices, time, lengths, amplitudes);
      replayer.evaluate(indices, time - step, before, ignored);
      replayer.evaluate(indices, time + step, after, ignored);
      for (size_t receiver = 0; receiver < 2; ++receiver) {
        for (size_t p = 0; p < indices.size(); ++p) {
          const size_t at = (2 * static_cast<size_t>(transmitter) + receiver) * indices.size() + p;
          evaluate_states(echoes[receiver], chirp, static_cast<int64_t>(p), 1, state);
          EXPECT_LT(kTwoPi * 77e9 * std::abs(state.delay[0] - lengths[at] / kSpeedOfLight), kPhaseTolerance);
          EXPECT_NEAR(state.rate[0] * kSpeedOfLight, (after[at] - before[at]) / (2 * step), kSlopeTolerance);
          const std::complex<double> amplitude(state.amplitude[0], state.amplitude[1]);
          EXPECT_LE(std::abs(amplitude - amplitudes[at]), kRounding * std::abs(amplitudes[at]));
          darkest = std::min(darkest, std::abs(amplitude));
          brightest = std::max(brightest, std::abs(amplitude));
        }
      }
    }
  }
  EXPECT_LT(darkest, 1e-3 * brightest);
}

// Cosine between the normal of a hit's triangle and the first transmitter, at one time: below 0 it shows its back.
double facing(const Paths& paths, const PathPreparer& preparer, const Radar& radar, int64_t path, double time) {
  const PosedScene scene(*paths.scene, radar, preparer.meshes(), paths.frame.transmitter, time);
  PosedHit posed;
  pose_hit(preparer.hit(*paths.hits_of(path)), scene, false, posed);
  return posed.normal.dot((scene.transmitters.front().position - posed.point).normalized());
}

TEST(Fading, WhatTurnsItsOtherSideIsLeftToTheChirpsAtOnceAndNothingElseIs) {
  RotorReplay rotor;
  auto& [radar, paths, replayer, path_grids, polynomial] = rotor;
  const PathPreparer preparer(paths, touched_meshes(paths));
  replayer.pose_polynomial(polynomial, all_of(paths));
  std::vector<int64_t> indices = all_of(paths);
  std::vector<UnfollowedPath> failed;
  const std::vector<Echoes> echoes = replayer.interpolated(indices, polynomial, failed);
  EXPECT_EQ(echoes.front().num_echoes, paths.num_paths() - static_cast<int64_t>(failed.size()));
  const double start = paths.frame.start_time, end = start + radar.frame_duration();
  int num_turned = 0, num_facing = 0;
  for (const int64_t path : indices) {
    const double first = facing(paths, preparer, radar, path, start), last = facing(paths, preparer, radar, path, end);
    const auto one =
        std::find_if(failed.begin(), failed.end(), [path](const UnfollowedPath& other) { return other.path == path; });
    if ((first > 0) != (last > 0)) {
      ++num_turned;
      ASSERT_NE(one, failed.end());
      EXPECT_TRUE(path_grids.next(*one, polynomial).by_chirp);
      EXPECT_TRUE(path_grids.next(*one, polynomial).grid == polynomial);
    } else if (std::min(first, last) > kGrazing) {  // turned by less than half a turn: seen all along
      ++num_facing;
      EXPECT_EQ(one, failed.end());
    }
  }
  EXPECT_GT(num_turned, 20);
  EXPECT_GT(num_facing, 10);
}

TEST(Fading, APolynomialThatDoesNotFollowALengthServesNoChirps) {
  RotorReplay rotor;
  auto& [radar, paths, replayer, path_grids, polynomial] = rotor;
  for (const bool is_turned : {false, true}) {
    const NextGrid next = path_grids.next({.path = 0, .order_for_length = 20.0, .is_turned = is_turned}, polynomial);
    EXPECT_FALSE(next.by_chirp);
    EXPECT_FALSE(next.grid == polynomial);
  }
}

// Lengths and amplitudes of the paths that a polynomial follows are those of the paths alone, wherever they stand in their
// block.
TEST(Fading, PathsThatAreFollowedKeepTheirPlaces) {
  RotorReplay rotor;
  auto& [radar, paths, replayer, path_grids, polynomial] = rotor;
  replayer.pose_polynomial(polynomial, all_of(paths));
  std::vector<int64_t> indices = all_of(paths);
  std::vector<UnfollowedPath> failed, none;
  const std::vector<Echoes> all = replayer.interpolated(indices, polynomial, failed);
  ASSERT_GT(failed.size(), 20u);
  for (const UnfollowedPath& one : failed) std::erase(indices, one.path);
  const std::vector<Echoes> alone = replayer.interpolated(indices, polynomial, none);
  EXPECT_TRUE(none.empty());
  for (size_t channel = 0; channel < all.size(); ++channel) {
    EXPECT_EQ(all[channel].delay, alone[channel].delay);
    EXPECT_EQ(all[channel].amplitude, alone[channel].amplitude);
  }
}

}  // namespace
}  // namespace echopath::test_fading
