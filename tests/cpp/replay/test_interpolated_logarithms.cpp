// Waves from a smooth body that moves by many wavelengths: the phase across a wide launch cell turns through cycles, and the
// amplitude is interpolated as a logarithm. Truth is the amplitude as evaluated at the time of a chirp, path by path.
#include <gtest/gtest.h>

#include <algorithm>

#include "cpp/replay/small_arrays.h"
#include "cpp/support/scenes.h"
#include "echopath/replay/replay.h"
#include "echopath/signal/echoes/echo_states.h"

namespace echopath::test_interpolated_logarithms {
namespace {

using namespace testing;

constexpr double kPhaseTolerance = 2e-5;      // rad: the aim of 1e-5; tails are estimates
constexpr double kAmplitudeTolerance = 2e-5;  // relative to the largest of the path: likewise

// A smooth drop of metal and a rough plate. With few rays the cells on the drop are wide.
Paths record(const Radar& radar) {
  Scene scene;
  Surface surface = ellipsoid(Vec3::Zero(), {1.4, 1.0, 1.2}, 5);
  Node node = node_with("drop", std::move(surface), share(Material::metal()), true);
  node.placement = Eigen::Translation3d(9, 1, 0) * Transform::Identity();
  node.motion = std::make_shared<LinearMotion>(Vec3(-40, 28, 0), Vec3(0, 0, 1.0));
  scene.add(node);
  add_rectangle(scene, "plate", Vec3(12, -4, -1), Vec3(0, 3, 0), Vec3(0, 0, 2), lambert(0.4));
  return trace(scene, radar, with_rays(600, 2));
}

Radar radar_of_a_long_frame() {
  Radar radar = two_by_two();
  radar.waveform.chirp_interval = 100e-6;
  return radar;
}

// Tries a polynomial on all paths, and then logarithms on those whose amplitudes it did not follow.
struct Tried {
  GridIndex polynomial;
  std::vector<int64_t> turning;  // paths whose logarithms were followed
  std::vector<Echoes> echoes;    // of these
};

Tried try_logarithms(const Paths& paths, Replayer& replayer) {
  Tried tried{replayer.path_grids().first(0), {}, {}};
  replayer.pose_polynomial(tried.polynomial, all_of(paths));
  std::vector<UnfollowedPath> unfollowed, failed;
  replayer.interpolated(all_of(paths), tried.polynomial, unfollowed);
  for (const UnfollowedPath& one : unfollowed) {
    const bool lacks_amplitude = one.order_for_length == 0.0 && !one.is_turned;
    if (lacks_amplitude && replayer.can_turn(one.path)) tried.turning.push_back(one.path);
  }
  tried.echoes = replayer.turning(tried.turning, tried.polynomial, failed);
  for (const UnfollowedPath& one : failed) std::erase(tried.turning, one.path);
  return tried;
}

TEST(InterpolatedLogarithms, InterpolatedLogarithmsHaveTheAmplitudesOfTheChirps) {
  const Radar radar = radar_of_a_long_frame();
  const Paths paths = record(radar);
  Replayer replayer(paths, radar);
  const Tried tried = try_logarithms(paths, replayer);
  const size_t num_paths = tried.turning.size();
  ASSERT_GT(num_paths, 30u);
  ASSERT_LE(replayer.grids().polynomial(tried.polynomial).order, 8);
  std::vector<double> lengths, largest(4 * num_paths), worst(4 * num_paths);
  std::vector<std::complex<double>> amplitudes;
  EchoStates state;
  for (int chirp = 0; chirp < radar.waveform.num_chirps; chirp += 9) {
    for (const size_t transmitter : {0u, 1u}) {
      const double time = paths.frame.start_time + radar.chirp_time(static_cast<int>(transmitter), chirp);
      replayer.evaluate(tried.turning, time, lengths, amplitudes);
      for (size_t receiver = 0; receiver < 2; ++receiver) {
        const size_t channel = 2 * transmitter + receiver;
        for (size_t p = 0; p < num_paths; ++p) {
          const size_t at = channel * num_paths + p;
          evaluate_states(tried.echoes[channel], chirp, static_cast<int64_t>(p), 1, state);
          EXPECT_LT(kTwoPi * 77e9 * std::abs(state.delay[0] - lengths[at] / kSpeedOfLight), kPhaseTolerance);
          const std::complex<double> found(state.amplitude[0], state.amplitude[1]);
          largest[at] = std::max(largest[at], std::abs(amplitudes[at]));
          worst[at] = std::max(worst[at], std::abs(found - amplitudes[at]));
        }
      }
    }
  }
  for (size_t at = 0; at < worst.size(); ++at) EXPECT_LE(worst[at], kAmplitudeTolerance * largest[at]);
}

// Otherwise the test above would show nothing: the phases between nodes are ambiguous by themselves.
TEST(InterpolatedLogarithms, PhasesTurnByMoreThanHalfACycleBetweenTheNodes) {
  const Radar radar = radar_of_a_long_frame();
  const Paths paths = record(radar);
  Replayer replayer(paths, radar);
  const Tried tried = try_logarithms(paths, replayer);
  const Echoes& echoes = tried.echoes.front();
  const auto count = static_cast<size_t>(echoes.num_echoes);
  EXPECT_EQ(count, tried.turning.size());
  size_t num_quick = 0;
  for (size_t p = 0; p < count; ++p) {
    double longest = 0.0;
    for (size_t at = p + count; at < echoes.amplitude.size(); at += count) {
      longest = std::max(longest, std::abs(echoes.amplitude[at].imag() - echoes.amplitude[at - count].imag()));
    }
    num_quick += longest > kPi;
  }
  EXPECT_GT(num_quick, 10u);
}

TEST(InterpolatedLogarithms, OnlyCoherentPathsOfRaysTurn) {
  const Radar radar = radar_of_a_long_frame();
  const Paths paths = record(radar);
  Replayer replayer(paths, radar);
  int num_coherent = 0, num_diffuse = 0;
  for (const int64_t path : all_of(paths)) {
    const auto p = static_cast<size_t>(path);
    const bool has_cell = paths.diffuse[p] == 0 && paths.stratum[p] != kNoStratum;
    EXPECT_EQ(replayer.can_turn(path), has_cell);
    (has_cell ? num_coherent : num_diffuse) += 1;
  }
  EXPECT_GT(num_coherent, 100);
  EXPECT_GT(num_diffuse, 100);
}

// Which paths stand beside it in a block changes nothing of an echo.
TEST(InterpolatedLogarithms, EchoesAreTheSameInAnyBlock) {
  const Radar radar = radar_of_a_long_frame();
  const Paths paths = record(radar);
  Replayer replayer(paths, radar);
  const Tried tried = try_logarithms(paths, replayer);
  ASSERT_FALSE(tried.turning.empty());
  for (size_t p = 0; p < tried.turning.size(); p += 17) {
    std::vector<UnfollowedPath> none;
    const std::vector<Echoes> alone = replayer.turning(std::span(&tried.turning[p], 1), tried.polynomial, none);
    ASSERT_TRUE(none.empty());
    for (size_t channel = 0; channel < alone.size(); ++channel) {
      const Echoes& all = tried.echoes[channel];
      for (size_t node = 0; node < alone[channel].delay.size(); ++node) {
        const size_t at = node * tried.turning.size() + p;
        EXPECT_EQ(alone[channel].delay[node], all.delay[at]);
        EXPECT_EQ(alone[channel].amplitude[node], all.amplitude[at]);
      }
    }
  }
}

}  // namespace
}  // namespace echopath::test_interpolated_logarithms
