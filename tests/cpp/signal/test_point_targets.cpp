// Points whose signal is known in closed form, as published for the reference radar (77 GHz, 1 GHz, 512 samples at 20
// MHz).
#include <gtest/gtest.h>

#include "cpp/signal/slow_sum.h"

namespace echopath::test_point_targets {
namespace {

using testing::Complex;

constexpr double kC = 299792458.0;
constexpr double kPowerRef = 0.01, kGainRef = 10.0;  // W, linear
constexpr double kLastDigitDb = 5e-4;                // of levels printed with three decimals
constexpr double kLastDigit = 5e-17;                 // s and sqrt(W), of numbers printed with ten digits
constexpr double kPrintedPhase = 1e-6;               // rad: printed with nine decimals; 1600 turns
constexpr double kPrintedDb = 0.01;                  // of an amplitude printed with ten digits
constexpr double kBin = 1e-3;        // of bins printed with four decimals or more, read off an interpolated peak
constexpr double kMovingBin = 0.01;  // likewise, of tones that change on the way, whose peaks are skewed
constexpr double kSlotPhase = 1e-3;  // rad: of a tone beside the middle of its cell
constexpr double kRounding = 1e-15;
constexpr double kSlopeRounding = 1e-12;  // of differences over hundredths of a second

double round_trip(double range) { return 2.0 * range / kC; }

// Radar equation, W; wavelength at the start frequency as in the reference numbers.
double received_power(double range, double cross_section) {
  const double wavelength = kC / 77e9;
  return kPowerRef * kGainRef * kGainRef * wavelength * wavelength * cross_section /
         (std::pow(4.0 * M_PI, 3) * std::pow(range, 4));
}

double spectrum_at(const std::vector<Complex>& samples, double bin) {
  Complex sum;
  const double n = static_cast<double>(samples.size());
  for (size_t i = 0; i < samples.size(); ++i) {
    sum += samples[i] * std::polar(1.0, -2.0 * M_PI * bin * static_cast<double>(i) / n);
  }
  return std::abs(sum) / n;
}

// The bin where the spectrum peaks, near `guess`: golden section.
double peak_bin(const std::vector<Complex>& samples, double guess) {
  double low = guess - 0.6, high = guess + 0.6;
  const double ratio = 0.6180339887498949;
  while (high - low > 1e-7) {
    const double a = high - ratio * (high - low), b = low + ratio * (high - low);
    const bool lower = spectrum_at(samples, a) > spectrum_at(samples, b);
    (lower ? high : low) = lower ? b : a;
  }
  return 0.5 * (low + high);
}

std::vector<Complex> row(const std::vector<Complex>& cube, int num_samples, int chirp) {
  return {cube.begin() + int64_t{chirp} * num_samples, cube.begin() + int64_t{chirp + 1} * num_samples};
}

// Slow-time signal of the beat tone: each chirp projected on the tone at the window centre.
std::vector<Complex> slow_time(const ChirpSequence& w, const std::vector<Complex>& cube, double range_bin) {
  std::vector<Complex> out;
  for (int j = 0; j < w.num_chirps; ++j) {
    Complex sum;
    for (int n = 0; n < w.num_samples; ++n) {
      const double cycles = range_bin * (n - 0.5 * (w.num_samples - 1)) / w.num_samples;
      sum += cube[int64_t{j} * w.num_samples + n] * std::polar(1.0, -2.0 * M_PI * cycles);
    }
    out.push_back(sum / static_cast<double>(w.num_samples));
  }
  return out;
}

class EveryMethod : public ::testing::TestWithParam<Method> {
 protected:
  SynthesisOptions options() const { return {1e-9, GetParam()}; }
};

INSTANTIATE_TEST_SUITE_P(Point, EveryMethod, ::testing::Values(Method::kDirect, Method::kRecurrence, Method::kNufft));

TEST(PointTarget, RadarEquationGivesThePublishedPowers) {
  const double rows[][3] = {{10, 1, -91.170}, {50, 1, -119.128}, {100, 10, -121.170}, {300, 10, -140.255}};
  for (const auto& [range, cross_section, dbm] : rows) {
    EXPECT_NEAR(10 * std::log10(received_power(range, cross_section)) + 30, dbm, kLastDigitDb);
  }
}

TEST_P(EveryMethod, StaticPointAtTwentyMetres) {
  const ChirpSequence w = testing::reference_waveform();
  const double tau = round_trip(20.0), amplitude = std::sqrt(received_power(20.0, 1.0));
  EXPECT_NEAR(tau, 1.334256381e-7, kLastDigit);
  EXPECT_NEAR(amplitude, 2.185018862e-7, kLastDigit);
  const auto cube = testing::synthesize(w, testing::static_echoes(w.num_chirps, {tau}, {amplitude}), options());
  const auto samples = row(cube, w.num_samples, 77);
  // Phase of the first sample: 10273.426428961 turns with the residual video phase.
  const double cycles = 10273.426428961, beat = 5211938.987;
  EXPECT_NEAR(std::arg(samples[0]), 2.679332180, kPrintedPhase);
  for (const int n : {0, 100, 511}) {
    const Complex expected = std::polar(1.0, 2 * M_PI * std::fmod(cycles + beat * n / w.sampling_rate, 1.0));
    EXPECT_NEAR(std::arg(samples[n] / expected), 0.0, kPrintedPhase) << n;
    EXPECT_NEAR(20 * std::log10(std::abs(samples[n]) / 2.185018862e-7), 0.0, kPrintedDb);
  }
  EXPECT_NEAR(peak_bin(samples, 133.4), 133.425638, kBin);
}

TEST_P(EveryMethod, RangeBins) {
  const ChirpSequence w = testing::reference_waveform();
  for (const auto& [range, bin] : {std::pair{10.0, 66.7128}, {37.5, 250.1731}, {60.0, 400.2769}}) {
    const auto cube = testing::synthesize(w, testing::static_echoes(w.num_chirps, {round_trip(range)}, {1.0}), options());
    EXPECT_NEAR(peak_bin(row(cube, w.num_samples, 0), std::round(bin)), bin, kBin);
  }
}

TEST_P(EveryMethod, MovingPoints) {
  struct Row {
    double range, speed, doppler_bin, range_bin, estimate;
  };
  const Row rows[] = {
      {20, 10, 19.8521, 133.6859, 9.9994}, {20, -10, -19.8522, 133.1654, -9.9994}, {50, 30, 59.5504, 334.3449, 29.9953}};
  const ChirpSequence w = testing::reference_waveform();
  for (const Row& expected : rows) {
    testing::MovingPoints point(1, 1, 1.0, 2.0);
    point.range = {expected.range};
    point.speed = {expected.speed};
    point.amplitude = {1.0};
    Echoes echoes = testing::exact_echoes(w, point);
    for (int j = 0; j < w.num_chirps; ++j) {
      echoes.delay[j] = round_trip(expected.range + expected.speed * (j * w.chirp_interval + w.window_centre()));
    }
    const auto cube = testing::synthesize(w, echoes, options());
    EXPECT_NEAR(peak_bin(row(cube, w.num_samples, w.num_chirps / 2), expected.range_bin), expected.range_bin, kMovingBin);
    const double doppler = peak_bin(slow_time(w, cube, expected.range_bin), expected.doppler_bin);
    EXPECT_NEAR(doppler, expected.doppler_bin, kMovingBin);
    // Receding is positive; the wavelength belongs to the centre of the sweep.
    const double speed = doppler * w.wavelength() / (2 * w.num_chirps * w.chirp_interval);
    EXPECT_NEAR(speed, expected.estimate, kMovingBin * 0.5037);
  }
}

TEST_P(EveryMethod, SampleErrorOfTheModelOnAMovingPointIsTheQuadraticTerm) {
  const ChirpSequence w = testing::reference_waveform();
  testing::MovingPoints point(1, 1, 1.0, 2.0);
  point.range = {20.0};
  point.speed = {30.0};
  point.amplitude = {1.0};
  Echoes echoes = testing::exact_echoes(w, point);
  const double slope = 1e9 * 20e6 / 512;
  const auto delay = [&](double t) { return round_trip(20.0 + 30.0 * t); };
  for (int j = 0; j < w.num_chirps; ++j) echoes.delay[j] = delay(j * w.chirp_interval + w.window_centre());
  const auto cube = testing::synthesize(w, echoes, options());
  double worst = 0.0;
  for (int n = 0; n < w.num_samples; ++n) {
    const double t = n / w.sampling_rate, tau = delay(64 * w.chirp_interval + t);
    const double cycles = std::fma(77e9, tau, -std::round(77e9 * tau)) + slope * tau * (t - 0.5 * tau);
    const Complex exact = std::polar(1.0, 2 * M_PI * (cycles - std::round(cycles)));
    worst = std::max(worst, std::abs(std::arg(cube[64 * 512 + n] / exact)));
  }
  EXPECT_NEAR(worst, 0.0080, 1e-4);  // 2 pi slope taudot (Tc / 2)^2
}

// A chirped Doppler is spread over 2 a T^2 / lambda bins: the region of the slow-time spectrum above half its level.
TEST(PointTarget, AccelerationSpreadsDoppler) {
  ChirpSequence w = testing::reference_waveform();
  w.num_chirps = 1000;
  w.chirp_interval = 20e-6;
  w.sampling_rate = 40e6;
  const double duration = w.num_chirps * w.chirp_interval;
  for (const auto& [acceleration, bins] : {std::pair{2.0, 0.414}, {5.0, 1.034}, {20.0, 4.136}}) {
    Echoes echoes = testing::exact_echoes(w, testing::MovingPoints(1, 1, 1.0, 2.0));
    for (int j = 0; j < w.num_chirps; ++j) {
      const double t = j * w.chirp_interval;
      echoes.delay[j] = round_trip(20.0 + 0.5 * acceleration * t * t);
      echoes.amplitude[j] = 1.0;
    }
    const auto cube = testing::synthesize(w, echoes, {.method = Method::kRecurrence});
    const auto signal = slow_time(w, cube, 133.4256);
    // Instantaneous frequency from phase steps over the first and the last hundredth of the frame, in Doppler bins.
    const auto frequency = [&](int j) { return std::arg(signal[j + 10] * std::conj(signal[j])) / (20 * M_PI) * 1000; };
    const double spread = (frequency(989) - frequency(0)) * duration / (989 * w.chirp_interval);
    EXPECT_NEAR(spread, bins, 0.1 * bins) << acceleration;
  }
}

// Phase beta cos(W t) has lines J_n(beta) at n W: they end sharply at n = beta, f_max = beta W / 2 pi.
TEST(PointTarget, RotatingPointHasBesselLines) {
  ChirpSequence w = testing::reference_waveform();
  w.num_samples = 64;
  w.bandwidth = 125e6;
  w.start_frequency = 77e9;
  w.chirp_interval = 100e-3 / 4096;  // one turn in the frame: lines fall on bins
  w.num_chirps = 4096;
  const double radius = 0.3, turns_per_second = 10.0;
  const double wavelength = kC / (77e9 + w.slope() * w.window_centre());
  Echoes echoes = testing::exact_echoes(w, testing::MovingPoints(1, 1, 1.0, 2.0));
  for (int j = 0; j < w.num_chirps; ++j) {
    const double angle = 2 * M_PI * turns_per_second * j * w.chirp_interval;
    echoes.delay[j] = round_trip(20.0 + radius * std::cos(angle));
    echoes.amplitude[j] = 1.0;
  }
  const auto cube = testing::synthesize(w, echoes, {.method = Method::kRecurrence});
  std::vector<Complex> signal;  // sample at the window centre: no range processing between the phase and the test
  for (int j = 0; j < w.num_chirps; ++j) signal.push_back(cube[int64_t{j} * 64 + 32]);
  const double beta = 4 * M_PI * radius / wavelength;
  double largest_error = 0.0;
  for (const int n : {0, 1, 500, 900, 960, 970, 990, 1020}) {
    largest_error = std::max(largest_error, std::abs(spectrum_at(signal, n) - std::abs(std::cyl_bessel_j(n, beta))));
  }
  EXPECT_LT(largest_error, 2e-3);
  int last = 0;  // highest line within 20 dB of the highest
  for (int n = 900; n < 1100; ++n) {
    if (spectrum_at(signal, n) > 0.1 * std::abs(std::cyl_bessel_j(static_cast<int>(beta), beta))) last = n;
  }
  int expected_last = 0;
  for (int n = 900; n < 1100; ++n) {
    if (std::cyl_bessel_j(n, beta) > 0.1 * std::cyl_bessel_j(static_cast<int>(beta), beta)) expected_last = n;
  }
  EXPECT_NEAR(last, expected_last, 1);
}

// Slots of transmitters see the target at their own times; nobody compensates that phase.
TEST(PointTarget, TdmSlotsTurnByTheDopplerPhase) {
  Radar radar;
  radar.waveform = testing::reference_waveform();
  radar.transmitters.resize(2);
  radar.receivers.resize(1);
  const ChirpSequence& w = radar.waveform;
  Synthesizer synthesizer(w, 2, 1, 1);
  for (int tx = 0; tx < 2; ++tx) {
    std::vector<double> times;
    for (int j = 0; j < w.num_chirps; ++j) times.push_back(radar.chirp_time(tx, j));
    Echoes echoes;
    echoes.num_echoes = 1;
    echoes.sampling = exact_sampling(times);
    for (const double t : times) echoes.delay.push_back(round_trip(20.0 + 10.0 * t));
    echoes.amplitude.assign(times.size(), 1.0);
    synthesizer.add(tx, echoes);
  }
  const auto cube = synthesizer.cube();
  const size_t half = cube.size() / 2, sample = 64 * 512 + 256;
  EXPECT_NEAR(std::arg(cube[half + sample] / cube[sample]), 0.974568, kSlotPhase);
}

TEST(Sampling, ExactSlopesDifferentiateParabolas) {
  const std::vector<double> times = {0.0, 0.1, 0.25, 0.3, 0.7};
  const TimeSampling sampling = exact_sampling(times);
  EXPECT_FALSE(sampling.is_static());
  for (size_t j = 0; j < times.size(); ++j) {
    double value = 0.0, slope = 0.0;
    for (int k = 0; k < sampling.order; ++k) {
      const double t = times[sampling.first_row[j] + k], f = 3.0 - 2.0 * t + 5.0 * t * t;
      value += sampling.value[j * sampling.order + k] * f;
      slope += sampling.slope[j * sampling.order + k] * f;
    }
    EXPECT_NEAR(value, 3.0 - 2.0 * times[j] + 5.0 * times[j] * times[j], kRounding);
    EXPECT_NEAR(slope, -2.0 + 10.0 * times[j], kSlopeRounding);
  }
}

TEST(Sampling, OneAndTwoTimes) {
  EXPECT_TRUE(exact_sampling({0.5}).is_static());
  const TimeSampling two = exact_sampling({0.5, 1.0});
  EXPECT_EQ(two.slope, (std::vector<double>{-2.0, 2.0, -2.0, 2.0}));
  EXPECT_EQ(two.value, (std::vector<double>{1.0, 0.0, 0.0, 1.0}));
  EXPECT_THROW(exact_sampling({}), std::invalid_argument);
  EXPECT_THROW(exact_sampling({1.0, 1.0}), std::invalid_argument);
  EXPECT_THROW(exact_sampling({0.0, std::nan("")}), std::invalid_argument);
  EXPECT_THROW(static_sampling(0), std::invalid_argument);
}

}  // namespace
}  // namespace echopath::test_point_targets
