// Echoes from chirp to chirp: of a plate that recedes, against the closed form, and sums against those in double precision.
#include <gtest/gtest.h>

#include <complex>
#include <numeric>
#include <random>
#include <span>

#include "cpp/support/scenes.h"
#include "echopath/label/cells/echo_histories.h"

namespace echopath::test_echo_histories {
namespace {

using namespace testing;

constexpr double kSingle = 2e-7;  // relative: rounding of single precision
constexpr double kSpeed = 20.0;   // m/s
constexpr double kAslant = 1e-5;  // m: the corners of the plate stand 0.4 degrees aside
constexpr double kFaded = 0.03;   // of the field: spreading over 0.1 m of 10 m, and the filter of a ray's cell
constexpr double kTurned = 2e-3;  // rad: ways of 0.2 m to single precision, and the sweep over what delays change

Paths receding_plate() {
  Scene scene;
  add_rectangle(scene, "plate", {10, -0.05, -0.05}, {0, 0.1, 0}, {0, 0, 0.1}, lambert(0.3),
                std::make_shared<LinearMotion>(kSpeed * Vec3::UnitX()));
  return trace(scene, plain_radar(Vec3::Zero(), Vec3::Zero()), with_rays(300, 1));
}

TEST(EchoHistories, FollowTheWayAndThePhaseOfAPlateThatRecedes) {
  const Paths paths = receding_plate();
  std::vector<int64_t> some(paths.num_paths());
  std::iota(some.begin(), some.end(), 0);
  std::swap(some.front(), some.back());
  const std::vector<double> times{0.0, 1e-3, 5e-3};
  const EchoHistories found = echo_histories(paths, some, times, 1e-3);
  ASSERT_GT(some.size(), 20u);
  const ChirpSequence& waveform = paths.radar.waveform;
  const double frequency = waveform.start_frequency + waveform.slope() * (waveform.window_centre() - 20.0 / kSpeedOfLight);
  for (size_t i = 0; i < some.size(); ++i) {
    EXPECT_GT(found.largest[i], 0.0);
    const std::span<const float> farther = std::span(found.farther).subspan(3 * i, 3);
    EXPECT_EQ(farther[1], 0.0f);
    EXPECT_NEAR(farther[0], -2.0 * kSpeed * 1e-3, kAslant);
    EXPECT_NEAR(farther[2], 2.0 * kSpeed * 4e-3, kAslant);
    const std::span<const std::complex<float>> field = std::span(found.field).subspan(3 * i, 3);
    for (size_t t = 0; t < 2; ++t) {
      EXPECT_NEAR(std::abs(field[t]), 1.0, kFaded);
      const double turns = frequency * (double{farther[t + 1]} - double{farther[t]}) / kSpeedOfLight;
      EXPECT_NEAR(std::arg(field[t + 1] * std::conj(field[t]) * std::complex<float>(std::polar(1.0, -kTwoPi * turns))), 0.0,
                  kTurned);
    }
  }
}

TEST(EchoHistories, AreNothingForNoPathsAndNoTimes) {
  const Paths paths = receding_plate();
  EXPECT_TRUE(echo_histories(paths, {}, std::vector<double>{0.0}, 0.0).field.empty());
  const std::vector<int64_t> some{0};
  EXPECT_TRUE(echo_histories(paths, some, {}, 0.0).field.empty());
}

TEST(EchoHistories, SumsOverRowsAreThoseInDoublePrecision) {
  std::mt19937 random(3);
  std::normal_distribution<float> normal;
  for (const size_t num_times : {1, 7, 8, 61}) {
    std::vector<std::complex<float>> table(40 * num_times), weights(3 * num_times);
    for (std::complex<float>& value : table) value = {normal(random), normal(random)};
    for (size_t i = num_times; i < weights.size(); ++i) weights[i] = {normal(random), normal(random)};
    std::fill_n(weights.end() - static_cast<std::ptrdiff_t>(num_times / 3), num_times / 3, 0.0f);
    const std::vector<int32_t> rows{39, 0, 7, 7};
    const auto sums = weighted_row_sums(table, rows, weights, num_times);
    ASSERT_EQ(sums.size(), 12u);
    for (size_t i = 0; i < sums.size(); ++i) {
      const size_t weight = i / rows.size(), row = static_cast<size_t>(rows[i % rows.size()]);
      std::complex<double> expected = 0.0;
      double size = 0.0;
      for (size_t t = 0; t < num_times; ++t) {
        const std::complex<double> a = table[row * num_times + t], b = weights[weight * num_times + t];
        expected += a * b;
        size += std::abs(a) * std::abs(b);
      }
      EXPECT_LE(std::abs(std::complex<double>(sums[i]) - expected), kSingle * size);
    }
  }
}

}  // namespace
}  // namespace echopath::test_echo_histories
