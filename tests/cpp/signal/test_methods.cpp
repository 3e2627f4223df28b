#include <gtest/gtest.h>

#include "cpp/signal/slow_sum.h"
#include "echopath/signal/methods/method.h"

namespace echopath::test_methods {
namespace {

using testing::Complex;

// A carrier of 1e5 turns known to one part in 2^53, and its slope from differences of such delays.
constexpr double kDoublePhaseError = 3e-11;
// Rounding of 512 samples of phase, relative to the amplitude.
constexpr double kToneRounding = 5e-13;
// 300 turns of beat phase, each of a handful of terms rounded once.
constexpr double kPhaseRounding = 2e-12;
// The largest error of one sample of a tone over its rms error: at the edge of the band the kernel's spectrum is
// smallest.
constexpr double kPeakOverRms = 8.0;

std::vector<double> frequencies() {
  std::vector<double> out = {0.0, 1e-9, 0.25, 0.5, 1.0 - 1e-9, 1.0 - 0x1.0p-53};
  for (int i = 1; i < 60; ++i) out.push_back(std::fmod(i * 0.6180339887498949, 1.0));
  return out;
}

// Samples of the tone c e^{j 2 pi f n} by a method, phase taken at sample 0.
std::vector<Complex> tone_samples(const ToneMethod& method, int num_samples, double frequency, Complex c) {
  const uint32_t group = 0;
  Carriers carriers;
  carriers.count = 1;
  carriers.group = &group;
  const Complex at_reference = c * std::polar(1.0, 2.0 * M_PI * std::fmod(frequency * method.reference_sample(), 1.0));
  carriers.frequency[0] = frequency;
  carriers.re[0] = at_reference.real();
  carriers.im[0] = at_reference.imag();
  std::vector<double> row(2 * method.row_length());
  double* const rows[] = {row.data()};
  method.add(carriers, {rows, 0});
  std::vector<Complex> out(num_samples);
  method.samples(row.data(), out.data());
  return out;
}

struct ToneError {
  double rms = 0.0, largest = 0.0;
};

// Returns the tone of each test frequency, by cosine and sine in extended precision. Those of the last number of samples
// asked for are kept: several methods and tolerances follow each other.
const std::vector<std::vector<Complex>>& exact_tones(int num_samples) {
  static std::vector<std::vector<Complex>> kept;
  if (!kept.empty() && kept[0].size() == static_cast<size_t>(num_samples)) return kept;
  kept.clear();
  for (const double frequency : frequencies()) {
    std::vector<Complex>& tone = kept.emplace_back();
    for (int n = 0; n < num_samples; ++n) {
      const long double cycles = static_cast<long double>(frequency) * n;
      const long double angle = 2 * std::numbers::pi_v<long double> * (cycles - std::round(cycles));
      tone.emplace_back(static_cast<double>(std::cos(angle)), static_cast<double>(std::sin(angle)));
    }
  }
  return kept;
}

// Worst errors over the test frequencies.
ToneError tone_error(const ToneMethod& method, int num_samples) {
  ToneError worst;
  const std::vector<double> all = frequencies();
  const auto& expected = exact_tones(num_samples);
  for (size_t i = 0; i < all.size(); ++i) {
    const auto actual = tone_samples(method, num_samples, all[i], 1.0);
    double sum = 0.0;
    for (int n = 0; n < num_samples; ++n) {
      const double error = std::abs(actual[n] - expected[i][n]);
      sum += error * error;
      worst.largest = std::max(worst.largest, error);
    }
    worst.rms = std::max(worst.rms, std::sqrt(sum / num_samples));
  }
  return worst;
}

TEST(Methods, DirectAndRecurrenceToneIsExactToRounding) {
  for (const int num_samples : {1, 31, 32, 33, 512}) {
    EXPECT_LT(tone_error(*make_direct(num_samples), num_samples).largest, kToneRounding) << num_samples;
    EXPECT_LT(tone_error(*make_recurrence(num_samples), num_samples).largest, kToneRounding) << num_samples;
  }
}

TEST(Methods, LongRecurrenceDoesNotDrift) {
  constexpr int kSamples = 65536;
  // Phase of the last sample when the frequency is rounded once.
  constexpr double kLastPhaseRounding = 2.0 * M_PI * kSamples * 0x1.0p-53;
  EXPECT_LT(tone_error(*make_recurrence(kSamples), kSamples).largest, 4.0 * kLastPhaseRounding);
}

// A product of frequency and sample, rounded before its whole turns are removed, would leave 1e-11 rad without fused
// operations.
TEST(Methods, LongDirectSumKeepsItsPhase) { EXPECT_LT(tone_error(*make_direct(65536), 65536).largest, kToneRounding); }

TEST(Methods, NufftToneHoldsItsToleranceAtEveryFrequency) {
  for (const int num_samples : {1, 2, 4, 6, 16, 64, 99, 100, 255, 512}) {
    for (const double tolerance : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12}) {
      const ToneError error = tone_error(*make_nufft(num_samples, tolerance), num_samples);
      EXPECT_LT(error.rms, tolerance + kToneRounding) << num_samples << " " << tolerance;
      EXPECT_LT(error.largest, kPeakOverRms * tolerance + kToneRounding) << num_samples << " " << tolerance;
    }
  }
}

// Returns the reference waveform of so many chirps, of complex and real samples, of chirps that rise and that fall.
std::vector<ChirpSequence> waveforms(int num_chirps) {
  std::vector<ChirpSequence> all;
  for (const bool real : {false, true}) {
    for (const double bandwidth : {1e9, -1e9}) {
      ChirpSequence& w = all.emplace_back(testing::reference_waveform());
      w.num_chirps = num_chirps;
      w.real = real;
      w.bandwidth = bandwidth;
    }
  }
  return all;
}

// Holds the slow sum of moving points in three chirps.
class SlowSum {
 public:
  SlowSum(const ChirpSequence& waveform, int num_points)
      : w_(waveform), points_(num_points, 7, 1.0, w_.max_range() + 10.0),  // some beyond the filter
        echoes_(testing::exact_echoes(w_, points_)), chirps_{0, w_.num_chirps / 2, w_.num_chirps - 1} {
    std::vector<double> taudot;
    for (const double speed : points_.speed) taudot.push_back(2.0 * speed / 299792458.0);
    for (const int chirp : chirps_) {
      const auto delay = echoes_.delay.begin() + int64_t{chirp} * num_points;
      const auto amplitude = echoes_.amplitude.begin() + int64_t{chirp} * num_points;
      expected_.push_back(testing::slow_chirp(w_, {delay, delay + num_points}, taudot, {amplitude, amplitude + num_points}));
    }
  }

  // Returns the largest error of the three chirps relative to the sum of |a|.
  double error_of(const SynthesisOptions& options) const {
    const auto cube = testing::synthesize(w_, echoes_, options);
    double largest = 0.0;
    for (size_t i = 0; i < chirps_.size(); ++i) {
      const auto samples = cube.begin() + int64_t{chirps_[i]} * w_.num_samples;
      largest = std::max(largest, testing::largest_difference({samples, samples + w_.num_samples}, expected_[i]));
    }
    return largest / testing::sum_of_magnitudes(points_.amplitude);
  }

 private:
  ChirpSequence w_;
  testing::MovingPoints points_;
  Echoes echoes_;
  std::vector<int> chirps_;
  std::vector<std::vector<Complex>> expected_;
};

// 4e4 turns of the carrier, rounded before the whole turns are removed, would leave 1e-11 rad.
TEST(Methods, StartPhaseKeepsAllBits) {
  ChirpSequence w = testing::reference_waveform();
  w.num_chirps = 1;
  const testing::MovingPoints points(40, 11, 60.0, 76.0);
  for (int p = 0; p < 40; ++p) {
    const std::vector<double> delay = {2.0 * points.range[p] / 299792458.0};
    const auto cube = testing::synthesize(w, testing::static_echoes(1, delay, {1.0}), {.method = Method::kDirect});
    EXPECT_LT(testing::largest_difference(cube, testing::slow_chirp(w, delay, {0.0}, {1.0})), kPhaseRounding);
  }
}

TEST(Methods, DirectAndRecurrenceEqualTheSlowSum) {
  for (const ChirpSequence& w : waveforms(8)) {
    for (const int count : {1, 3, 300}) {
      const SlowSum slow(w, count);
      EXPECT_LT(slow.error_of({.method = Method::kDirect}), kDoublePhaseError) << count;
      EXPECT_LT(slow.error_of({.method = Method::kRecurrence}), kDoublePhaseError) << count;
    }
  }
}

TEST(Methods, NufftEqualsTheSlowSumWithinItsTolerance) {
  for (const ChirpSequence& w : waveforms(4)) {
    const SlowSum slow(w, 300);
    for (const double tolerance : {1e-3, 1e-5, 1e-7, 1e-9, 1e-12}) {
      EXPECT_LT(slow.error_of({tolerance, Method::kNufft}), tolerance + kDoublePhaseError) << tolerance;
    }
  }
}

TEST(Methods, AutomaticChoiceDependsOnTheNumberOfEchoesAlone) {
  const ChirpSequence w = testing::reference_waveform();
  for (const int num_groups : {1, 100}) {
    EXPECT_EQ(Synthesizer(w, 1, num_groups, 10).method(), Method::kRecurrence);
    EXPECT_EQ(Synthesizer(w, 1, num_groups, 1000).method(), Method::kNufft);
  }
}

// A strong echo must not hide a weak one 100 dB below by its spurs.
TEST(Methods, WeakToneBesideAStrongOneIsKept) {
  ChirpSequence w = testing::reference_waveform();
  w.num_chirps = 1;
  const double strong = 2 * 20.0 / 299792458.0, weak = 2 * 50.0 / 299792458.0;
  const SynthesisOptions options{1e-9, Method::kNufft};
  const auto both = testing::synthesize(w, testing::static_echoes(1, {strong, weak}, {1.0, 1e-5}), options);
  const auto expected_strong = testing::slow_chirp(w, {strong}, {0.0}, {1.0});
  const auto expected_weak = testing::slow_chirp(w, {weak}, {0.0}, {1e-5});
  Complex correlation;
  for (int n = 0; n < w.num_samples; ++n) {
    correlation += (both[n] - expected_strong[n]) * std::conj(expected_weak[n]) / (1e-10 * w.num_samples);
  }
  EXPECT_NEAR(20 * std::log10(std::abs(correlation)), 0.0, 0.1);
}

}  // namespace
}  // namespace echopath::test_methods
