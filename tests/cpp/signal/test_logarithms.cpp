// Echoes whose amplitudes stand as logarithms at their nodes: of even logarithms the amplitude is known in closed form.
#include <gtest/gtest.h>

#include "cpp/signal/slow_sum.h"
#include "echopath/signal/echoes/echo_states.h"

namespace echopath::test_logarithms {
namespace {

using testing::Complex;

constexpr double kRounding = 1e-12;         // relative, of an amplitude: phases of up to 600 rad, in double
constexpr double kCarrierRounding = 2e-11;  // likewise, of samples: delays of 2e-7 s, rounded, times 5e11 rad/s
constexpr double kNothing = 3.5e-308;       // sqrt(W): e^-708, below which sizes are 0
constexpr int kCount = 37;                  // fills no vector of any instruction set

ChirpSequence few_chirps() {
  ChirpSequence w = testing::reference_waveform();
  w.num_chirps = 7;
  return w;
}

// Fades and turns evenly from the first node to the second; the delay drifts evenly.
struct TurningPoint {
  double delay, drift;          // s
  double logarithm, fall;       // of sqrt(W)
  double phase, phase_to_turn;  // rad
  Complex at(double share) const { return std::polar(std::exp(logarithm - share * fall), phase + share * phase_to_turn); }
};

std::vector<TurningPoint> turning_points() {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<TurningPoint> points;
  for (int p = 0; p < kCount; ++p) {
    points.push_back({1e-7 + 1e-7 * unit(random), 4e-11 * (unit(random) - 0.5), 3.0 * unit(random) - 2.0,
                      200.0 * unit(random), 6.0 * unit(random), 1200.0 * (unit(random) - 0.5)});
  }
  points[0].fall = 1e4;  // down to nothing that a number can hold
  return points;
}

double share_of(const ChirpSequence& w, int chirp) { return (chirp + 0.5) / w.num_chirps; }

Echoes echoes_of(const ChirpSequence& w, const std::vector<TurningPoint>& points) {
  Echoes echoes;
  echoes.num_echoes = kCount;
  echoes.sampling.num_rows = echoes.sampling.order = 2;
  echoes.sampling.rows = TimeSampling::Rows::kLogarithms;
  echoes.sampling.first_row.assign(static_cast<size_t>(w.num_chirps), 0);
  const double span = w.num_chirps * w.chirp_interval;
  for (int chirp = 0; chirp < w.num_chirps; ++chirp) {
    const double x = share_of(w, chirp);
    echoes.sampling.value.insert(echoes.sampling.value.end(), {1.0 - x, x});
    echoes.sampling.slope.insert(echoes.sampling.slope.end(), {-1.0 / span, 1.0 / span});
  }
  for (const double share : {0.0, 1.0}) {
    for (const TurningPoint& point : points) {
      echoes.delay.push_back(point.delay + share * point.drift);
      echoes.amplitude.emplace_back(point.logarithm - share * point.fall, point.phase + share * point.phase_to_turn);
    }
  }
  return echoes;
}

TEST(Logarithms, EveryMethodHasTheAmplitudesOfTheClosedForm) {
  const ChirpSequence w = few_chirps();
  const std::vector<TurningPoint> points = turning_points();
  const Echoes echoes = echoes_of(w, points);
  std::vector<Complex> expected;
  double largest = 0.0;
  for (int chirp = 0; chirp < w.num_chirps; ++chirp) {
    const double share = share_of(w, chirp);
    std::vector<double> delay, rate;
    std::vector<Complex> amplitude;
    for (const TurningPoint& point : points) {
      delay.push_back(point.delay + share * point.drift);
      rate.push_back(point.drift / (w.num_chirps * w.chirp_interval));
      amplitude.push_back(point.at(share));
    }
    const std::vector<Complex> samples = testing::slow_chirp(w, delay, rate, amplitude);
    expected.insert(expected.end(), samples.begin(), samples.end());
    largest = std::max(largest, testing::sum_of_magnitudes(amplitude));
  }
  struct Case {
    Method method;
    double tolerance, error;
  };
  for (const Case& one :
       {Case{Method::kDirect, 1e-12, kCarrierRounding}, Case{Method::kRecurrence, 1e-12, kCarrierRounding},
        Case{Method::kNufft, 1e-12, kCarrierRounding}, Case{Method::kNufft, 1e-7, 1e-6}, Case{Method::kNufft, 1e-3, 1e-2}}) {
    const std::vector<Complex> found = testing::synthesize(w, echoes, {one.tolerance, one.method});
    EXPECT_LT(testing::largest_difference(found, expected), one.error * largest) << one.tolerance;
  }
}

TEST(Logarithms, StatesHoldAmplitudes) {
  const ChirpSequence w = few_chirps();
  const std::vector<TurningPoint> points = turning_points();
  const Echoes echoes = echoes_of(w, points);
  std::vector<EchoStates> states(static_cast<size_t>(w.num_chirps));
  evaluate_states(echoes, 0, w.num_chirps, 0, kCount, states.data());
  for (int chirp = 0; chirp < w.num_chirps; ++chirp) {
    for (size_t p = 0; p < kCount; ++p) {
      const double* amplitude = states[static_cast<size_t>(chirp)].amplitude + 2 * p;
      const Complex expected = points[p].at(share_of(w, chirp));
      EXPECT_LE(std::abs(Complex(amplitude[0], amplitude[1]) - expected), kRounding * std::abs(expected) + kNothing);
    }
  }
}

}  // namespace
}  // namespace echopath::test_logarithms
