// Values at nodes give values and slopes at the chirps: exact for polynomials, per smooth piece.
#include <gtest/gtest.h>

#include <functional>

#include "cpp/support/scenes.h"
#include "echopath/replay/time/frame_nodes.h"

namespace echopath::test_frame_nodes {
namespace {

using namespace testing;

constexpr double kPolynomialTolerance = 1e-13;  // relative: rounding of about ten terms
constexpr double kStart = 0.25;                 // s
constexpr double kDerivatives = 1e-9;           // of derivatives that are made of differences of ten values

Radar two_transmitters(int num_chirps) {
  Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero());
  radar.waveform.num_chirps = num_chirps;
  radar.transmitters.push_back(radar.transmitters.front());
  return radar;
}

using Function = std::function<double(double)>;

// Largest error of value and of slope over all chirps of the transmitters from `first_transmitter` on that have a sampling.
std::pair<double, double> errors(const FrameNodes& nodes, const Radar& radar, const Function& f, const Function& derivative,
                                 size_t first_transmitter = 0) {
  double value_error = 0.0, slope_error = 0.0;
  for (size_t tx = first_transmitter; tx < first_transmitter + nodes.sampling.size(); ++tx) {
    const TimeSampling& sampling = nodes.sampling[tx - first_transmitter];
    for (int chirp = 0; chirp < radar.waveform.num_chirps; ++chirp) {
      double value = 0.0, slope = 0.0;
      for (int k = 0; k < sampling.order; ++k) {
        const auto weight = static_cast<size_t>(chirp * sampling.order + k);
        const auto place = static_cast<size_t>(sampling.first_row[static_cast<size_t>(chirp)] + k);
        const double node = f(nodes.times[place] - kStart);
        value += sampling.value[weight] * node;
        slope += sampling.slope[weight] * node;
      }
      const double time = radar.chirp_time(static_cast<int>(tx), chirp);
      value_error = std::max(value_error, std::abs(value - f(time)));
      slope_error = std::max(slope_error, std::abs(slope - derivative(time)));
    }
  }
  return {value_error, slope_error};
}

TEST(ChebyshevNodes, PolynomialsBelowTheirOrderAreExact) {
  const Radar radar = two_transmitters(64);
  const double frame = radar.frame_duration();
  const auto f = [&](double t) { return 1.0 + 3.0 * t / frame - 2.0 * std::pow(t / frame, 5); };
  const auto derivative = [&](double t) { return (3.0 - 10.0 * std::pow(t / frame, 4)) / frame; };
  const auto [value, slope] = errors(chebyshev_nodes(radar, kStart, {}, 6), radar, f, derivative);
  EXPECT_LT(value, kPolynomialTolerance);
  EXPECT_LT(slope * frame, 100 * kPolynomialTolerance);  // differentiation amplifies rounding by about K^2
}

TEST(ChebyshevNodes, KinksAtBreakpointsDoNoHarm) {
  const Radar radar = two_transmitters(64);
  const double kink = 0.4 * radar.frame_duration();
  const auto f = [&](double t) { return t < kink ? t / kink : 1.0 - 2.0 * (t - kink) / kink; };
  const auto derivative = [&](double t) { return t < kink ? 1.0 / kink : -2.0 / kink; };
  const auto [value, slope] =
      errors(chebyshev_nodes(radar, kStart, {kStart - 1.0, kStart + kink, kStart + 9.0}, 6), radar, f, derivative);
  EXPECT_LT(value, kPolynomialTolerance);
  EXPECT_LT(slope * kink, 100 * kPolynomialTolerance);
  const auto [without, ignored] = errors(chebyshev_nodes(radar, kStart, {}, 6), radar, f, derivative);
  EXPECT_GT(without, 1e-2);  // and without the cut they do
}

// The value at the breakpoint itself is that behind the jump, so no piece before it may ask for it.
TEST(ChebyshevNodes, JumpsAtBreakpointsDoNoHarm) {
  const Radar radar = two_transmitters(64);
  const double frame = radar.frame_duration(), jump = 0.37 * frame;
  const auto f = [&](double t) { return (kStart + t >= kStart + jump ? 5.0 : 1.0) + t / frame; };
  const auto derivative = [&](double) { return 1.0 / frame; };
  const auto [value, slope] = errors(chebyshev_nodes(radar, kStart, {kStart + jump}, 6), radar, f, derivative);
  EXPECT_LT(value, kPolynomialTolerance);
  EXPECT_LT(slope * frame, 1000 * kPolynomialTolerance);  // pieces are shorter than the frame
}

TEST(ChebyshevNodes, TailShowsWhatThePolynomialLacks) {
  const Radar radar = two_transmitters(16);
  const double frame = radar.frame_duration();
  const FrameNodes nodes = chebyshev_nodes(radar, 0.0, {}, 6);
  double before_last = 0.0, last = 0.0;
  for (size_t k = 0; k < 6; ++k) {
    const double x = 2.0 * nodes.times[k] / frame - 1.0;
    const double fourth = 8 * std::pow(x, 4) - 8 * x * x + 1, fifth = 16 * std::pow(x, 5) - 20 * x * x * x + 5 * x;
    const double value = 7.0 + 0.5 * fourth + 0.25 * fifth;
    before_last += nodes.tail[k] * value;  // T_4
    last += nodes.tail[6 + k] * value;     // T_5
  }
  EXPECT_NEAR(before_last, 0.5, kPolynomialTolerance);
  EXPECT_NEAR(last, 0.25, kPolynomialTolerance);
}

TEST(ExactNodes, ValuesAreThoseOfTheChirps) {
  const Radar radar = two_transmitters(32);
  const auto f = [](double t) { return 10.0 - 30.0 * t + 40.0 * t * t; };
  const auto derivative = [](double t) { return -30.0 + 80.0 * t; };
  for (int tx : {0, 1}) {
    const auto [value, slope] = errors(exact_nodes(radar, kStart, 3, tx), radar, f, derivative, static_cast<size_t>(tx));
    EXPECT_LT(value, kPolynomialTolerance * 10);
    EXPECT_LT(slope, 1e-8);  // exact for parabolas up to rounding / 25 us
  }
}

TEST(ExactNodes, DerivativesAreThoseOfTheCubicInAChirp) {
  const Radar radar = two_transmitters(4);
  const double half = radar.waveform.window_centre();
  const FrameNodes nodes = exact_nodes(radar, kStart, 5, 1);
  const TimeSampling& sampling = nodes.sampling[0];
  for (int chirp = 0; chirp < 4; ++chirp) {
    const double middle = kStart + radar.chirp_time(1, chirp);
    double second = 0.0, third = 0.0;
    for (int k = 0; k < 5; ++k) {
      const auto place = static_cast<size_t>(sampling.first_row[static_cast<size_t>(chirp)] + k);
      const double x = (nodes.times[place] - middle) / half;
      const double value = 1.0 + 2.0 * x - 3.0 * x * x + 4.0 * x * x * x;
      second += sampling.second_derivative[static_cast<size_t>(5 * chirp + k)] * value;
      third += sampling.third_derivative[static_cast<size_t>(5 * chirp + k)] * value;
    }
    EXPECT_NEAR(second * half * half, -6.0, kDerivatives);
    EXPECT_NEAR(third * half * half * half, 24.0, kDerivatives);
  }
}

TEST(ExactNodes, FramesOfOneSampleHaveNoSlope) {
  Radar radar = two_transmitters(1);
  radar.waveform.num_samples = 1;
  const TimeSampling sampling = exact_nodes(radar, kStart, 3, 0).sampling[0];
  EXPECT_NEAR(sampling.value[0] + sampling.value[1] + sampling.value[2], 1.0, 0.1 * kPolynomialTolerance);
  for (const double slope : sampling.slope) EXPECT_EQ(slope, 0.0);
}

TEST(StaticNodes, OneNodeServesAllChirps) {
  const FrameNodes nodes = static_nodes(two_transmitters(8), 0.5);
  EXPECT_EQ(nodes.times, std::vector<double>{0.5});
  for (const TimeSampling& sampling : nodes.sampling) EXPECT_TRUE(sampling.is_static());
}

}  // namespace
}  // namespace echopath::test_frame_nodes
