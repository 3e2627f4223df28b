#include <gtest/gtest.h>

#include "cpp/signal/slow_sum.h"

namespace echopath {
namespace {

using testing::Complex;

// Phases of 1e5 turns in double: 1e-16 x 512 samples x 2 pi for the tone, 1e-11 rad for the rounding of the delay weights.
constexpr double kDoublePhaseError = 3e-11;

double error_against_slow_sum(const ChirpSequence& w, int num_points, const SynthesisOptions& options) {
  const testing::MovingPoints points(num_points, 7, 1.0, w.max_range() + 10.0);
  const Echoes echoes = testing::exact_echoes(w, points);
  const auto cube = testing::synthesize(w, echoes, options);
  double largest = 0.0;
  for (const int chirp : {0, w.num_chirps / 2, w.num_chirps - 1}) {
    const int64_t at = int64_t{chirp} * num_points;
    std::vector<double> tau(echoes.delay.begin() + at, echoes.delay.begin() + at + num_points), taudot;
    for (const double speed : points.speed) taudot.push_back(2.0 * speed / 299792458.0);
    std::vector<Complex> amplitude(echoes.amplitude.begin() + at, echoes.amplitude.begin() + at + num_points);
    const auto expected = testing::slow_chirp(w, tau, taudot, amplitude);
    const std::vector<Complex> actual(cube.begin() + int64_t{chirp} * w.num_samples,
                                      cube.begin() + int64_t{chirp + 1} * w.num_samples);
    largest = std::max(largest, testing::largest_difference(actual, expected));
  }
  return largest / testing::sum_of_magnitudes(points.amplitude);
}

TEST(Methods, DirectAndRecurrenceEqualTheSlowSum) {
  ChirpSequence w = testing::reference_waveform();
  w.num_chirps = 8;
  for (const Method method : {Method::kDirect, Method::kRecurrence}) {
    for (const int count : {1, 3, 300}) {
      EXPECT_LT(error_against_slow_sum(w, count, {.method = method}), kDoublePhaseError) << count;
    }
  }
}

}  // namespace
}  // namespace echopath
