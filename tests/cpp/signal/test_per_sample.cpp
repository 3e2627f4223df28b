// Echoes with the delay of every sample against the phase model written out in extended precision.
#include <gtest/gtest.h>

#include <functional>

#include "cpp/signal/slow_sum.h"

namespace echopath::test_per_sample {
namespace {

using testing::Complex;

constexpr double kC = 299792458.0;
constexpr double kRounding = 1e-9;     // rad: 1e4 turns in double
constexpr double kLeftOutTerm = 5e-7;  // rad: tau'''' x^4 / 24 of the rotor below
constexpr double kRate = 800.0;        // rad/s
constexpr double kBlade = 0.3;         // m

// Derivative `order` of the delay of a blade's tip 20 m away.
double rotor_delay(double t, int order) {
  const double cosine = std::cos(kRate * t + order * M_PI / 2);
  return 2.0 / kC * ((order == 0 ? 20.0 : 0.0) + kBlade * std::pow(kRate, order) * cosine);
}

const Complex kAmplitude(0.6, 0.8);

// An echo whose "nodes" are the derivatives of its delay at each chirp.
Echoes echo_of(const ChirpSequence& w, const std::function<double(double, int)>& delay) {
  Echoes echoes;
  echoes.num_echoes = 1;
  TimeSampling& sampling = echoes.sampling;
  sampling.order = 4;
  sampling.num_rows = 4 * w.num_chirps;
  std::vector<double>* const rows[4] = {&sampling.value, &sampling.slope, &sampling.second_derivative,
                                        &sampling.third_derivative};
  for (int j = 0; j < w.num_chirps; ++j) {
    sampling.first_row.push_back(4 * j);
    for (int d = 0; d < 4; ++d) {
      for (int k = 0; k < 4; ++k) rows[d]->push_back(k == d ? 1.0 : 0.0);
      echoes.delay.push_back(delay(j * w.chirp_interval + w.window_centre(), d));
      echoes.amplitude.push_back(d == 0 ? kAmplitude : 0.0);
    }
  }
  return echoes;
}

// Largest phase error over the samples of all chirps.
double phase_error(const ChirpSequence& w, const std::function<double(double, int)>& delay, bool per_sample) {
  const auto cube = testing::synthesize(w, echo_of(w, delay), {.tolerance = 1e-12, .per_sample = per_sample});
  using Real = long double;
  const Real slope = w.slope(), turn = 2 * std::numbers::pi_v<Real>;
  double worst = 0.0;
  for (int j = 0; j < w.num_chirps; ++j) {
    for (int n = 0; n < w.num_samples; ++n) {
      const double t = n / w.sampling_rate;
      const Real tau = delay(j * w.chirp_interval + t, 0);
      const Real cycles = Real{w.start_frequency} * tau + slope * tau * (t - tau / 2);
      const Complex model =
          std::conj(kAmplitude) * std::polar(1.0, static_cast<double>(turn * (cycles - std::round(cycles))));
      worst = std::max(worst, std::abs(std::arg(cube[static_cast<size_t>(j * w.num_samples + n)] / model)));
    }
  }
  return worst;
}

TEST(PerSample, FastPointHasItsExactPhase) {
  const auto delay = [](double t, int order) {
    return order == 0 ? 2.0 / kC * (20.0 + 60.0 * t) : order == 1 ? 120.0 / kC : 0.0;
  };
  EXPECT_LT(phase_error(testing::reference_waveform(), delay, true), kRounding);
  EXPECT_NEAR(phase_error(testing::reference_waveform(), delay, false), 0.0160, 1e-4);  // 2 pi slope taudot (Tc / 2)^2
}

TEST(PerSample, RotorErrsByTheFourthDerivativeOnly) {
  ChirpSequence w = testing::reference_waveform();
  for (const double bandwidth : {1e9, -1e9}) {
    w.bandwidth = bandwidth;
    const double error = phase_error(w, rotor_delay, true);
    EXPECT_LT(error, kLeftOutTerm);
    EXPECT_GT(error, kLeftOutTerm / 10);
    EXPECT_GT(phase_error(w, rotor_delay, false), 0.05);
  }
}

TEST(PerSample, EchoesAtRestKeepTheMethodAndFarOnesAreFiltered) {
  const ChirpSequence w = testing::reference_waveform();
  const auto beyond = [](double, int order) { return order == 0 ? 2.0 / kC * 80.0 : 0.0; };  // maximum range: 76.7 m
  for (const Complex& sample : testing::synthesize(w, echo_of(w, beyond), {.per_sample = true})) EXPECT_EQ(sample, 0.0);
  const Echoes still = testing::static_echoes(w.num_chirps, {1.3e-7, 2.7e-7}, {1.0, {0.0, 0.5}});
  EXPECT_EQ(testing::synthesize(w, still, {.per_sample = true}), testing::synthesize(w, still, {}));
}

}  // namespace
}  // namespace echopath::test_per_sample
