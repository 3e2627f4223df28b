#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "cpp/support/any_threads.h"
#include "cpp/support/expect_error.h"
#include "cpp/support/waveforms.h"
#include "echopath/spectrum/range_doppler.h"

namespace echopath::test_range_doppler {
namespace {

using Complex = std::complex<double>;
constexpr double kRounding = 1e-13;      // relative to a tone of unit power
constexpr double kAxisRounding = 1e-12;  // m and m/s

Radar small_radar(int num_tx = 1, int num_rx = 1) {
  Radar radar;
  radar.waveform = testing::small_waveform(1e9, 20e6, 32, 16);
  radar.transmitters.resize(num_tx);
  radar.receivers.resize(num_rx);
  return radar;
}

// One tone per channel: range bin r + channel, Doppler bin d, amplitude 1 + channel; real: sqrt 2 times the real part.
std::vector<Complex> tones(const Radar& radar, double r, double d) {
  const ChirpSequence& w = radar.waveform;
  const int channels = static_cast<int>(radar.transmitters.size() * radar.receivers.size());
  std::vector<Complex> cube;
  for (int c = 0; c < channels; ++c) {
    for (int j = 0; j < w.num_chirps; ++j) {
      for (int n = 0; n < w.num_samples; ++n) {
        const double cycles = (r + c) * n / w.num_samples + d * j / w.num_chirps + 0.1;
        const Complex s = (1.0 + c) * std::polar(1.0, 2.0 * std::numbers::pi * cycles);
        cube.push_back(w.real ? Complex(std::numbers::sqrt2 * s.real()) : s);
      }
    }
  }
  return cube;
}

TEST(RangeDoppler, MeanPowerIsTheMeanOverChannels) {
  RangeDoppler map;
  map.num_receivers = 2, map.num_transmitters = 1;
  map.velocity = {0.0}, map.range = {0.0, 1.0};
  map.values = {{3, 4}, {0, 1}, {1, 0}, {2, 0}};
  EXPECT_EQ(mean_power(map), (std::vector<double>{13.0, 2.5}));
}

TEST(RangeDoppler, EqualsTheSlowTransform) {
  const Radar radar = small_radar();
  const ChirpSequence& w = radar.waveform;
  const auto cube = tones(radar, 5.3, -2.2);
  const Window window{WindowKind::kHamming};
  const int pad = 2;
  const RangeDoppler map = range_doppler(cube, radar, window, pad);
  const auto wr = window_samples(window, w.num_samples), wd = window_samples(window, w.num_chirps);
  const double scale = std::accumulate(wr.begin(), wr.end(), 0.0) * std::accumulate(wd.begin(), wd.end(), 0.0);
  ASSERT_EQ(map.range.size(), 64u);
  ASSERT_EQ(map.velocity.size(), 32u);
  for (int v = 0; v < 32; ++v) {
    for (int r = 0; r < 64; ++r) {
      Complex sum;
      for (int j = 0; j < w.num_chirps; ++j) {
        for (int n = 0; n < w.num_samples; ++n) {
          const double cycles = r * n / 64.0 + (v - 16) * j / 32.0;
          sum += cube[j * w.num_samples + n] * wr[n] * wd[j] * std::polar(1.0, -2.0 * std::numbers::pi * cycles);
        }
      }
      EXPECT_NEAR(std::abs(map.values[v * 64 + r] - sum / scale), 0.0, kRounding);
    }
  }
}

TEST(RangeDoppler, PeakIsReceivedPowerInEveryChannelAndWindow) {
  const Radar radar = small_radar(2, 3);
  const auto cube = tones(radar, 4.0, 3.0);
  const Window windows[] = {
      {WindowKind::kRect}, {WindowKind::kHann}, {WindowKind::kChebyshev, 60.0}, {WindowKind::kTaylor, 35.0}};
  for (const Window& window : windows) {
    const RangeDoppler map = range_doppler(cube, radar, window);
    for (int c = 0; c < 6; ++c) {
      const Complex peak = map.values[(c * 16 + 8 + 3) * 32 + 4 + c];
      EXPECT_NEAR(std::norm(peak), (1.0 + c) * (1.0 + c), 10 * kRounding);
    }
  }
}

TEST(RangeDoppler, RealSamplesKeepHalfTheRangesAndThePower) {
  Radar radar = small_radar();
  radar.waveform.real = true;
  const RangeDoppler map = range_doppler(tones(radar, 4.0, -3.0), radar, Window{WindowKind::kRect});
  ASSERT_EQ(map.range.size(), 16u);
  EXPECT_NEAR(std::norm(map.values[(8 - 3) * 16 + 4]), 1.0, 10 * kRounding);
  EXPECT_LT(map.range.back(), radar.waveform.max_range());
}

TEST(RangeDoppler, AxesFollowTheWaveform) {
  const Radar radar = small_radar(2);
  const RangeDoppler map = range_doppler(tones(radar, 1, 1), radar, {}, 4);
  const double wavelength = 299792458.0 / 77.5e9;  // at the centre of the sweep
  EXPECT_NEAR(map.range[4], 299792458.0 / 2e9, kAxisRounding);
  EXPECT_EQ(map.velocity[32], 0.0);
  // One unpadded Doppler bin: lambda / (2 x chirps x slots x interval).
  EXPECT_NEAR(map.velocity[36], wavelength / (2 * 16 * 2 * 30e-6), kAxisRounding);
  EXPECT_NEAR(map.velocity.front(), -wavelength / (4 * 2 * 30e-6), kAxisRounding);
}

TEST(RangeDoppler, DoesNotDependOnTheNumberOfThreads) {
  const Radar radar = small_radar(2, 2);
  const auto cube = tones(radar, 3.3, 1.7);
  test::same_on_any_threads([&] { return range_doppler(cube, radar, {}, 2).values; });
}

TEST(RangeDoppler, ASingleChirpAndSampleIsItsOwnMap) {
  Radar radar = small_radar();
  radar.waveform.num_chirps = radar.waveform.num_samples = 1;
  const RangeDoppler map = range_doppler({Complex(2.0, 1.0)}, radar);
  ASSERT_EQ(map.values.size(), 1u);
  EXPECT_NEAR(std::abs(map.values[0] - Complex(2.0, 1.0)), 0.0, kRounding);
}

TEST(RangeDoppler, ZerosGiveZeros) {
  const Radar radar = small_radar();
  for (const Complex& value : range_doppler(std::vector<Complex>(512), radar).values) EXPECT_EQ(value, Complex());
}

TEST(RangeDoppler, BadInputIsAnError) {
  const Radar radar = small_radar();
  EXPECT_THROW(range_doppler(std::vector<Complex>(511), radar), std::invalid_argument);
  EXPECT_THROW(range_doppler(std::vector<Complex>(512), radar, {}, 0), std::invalid_argument);
  EXPECT_THROW(range_doppler(std::vector<Complex>(512), radar, {}, 65), std::invalid_argument);
  EXPECT_THROW(range_doppler(std::vector<Complex>(512), Radar{}), std::invalid_argument);
  Job job;
  job.cancel();
  EXPECT_THROW(range_doppler(std::vector<Complex>(512), radar, {}, 1, &job), Cancelled);
}

TEST(RangeDoppler, RefusesMapsThatNoTransformCanIndex) {
  Radar radar = small_radar();
  radar.waveform.num_samples = 1 << 26;
  radar.waveform.chirp_interval = 10.0;
  test::expect_error<std::invalid_argument>([&] { range_doppler({}, radar, {}, 64); }, {"below 2^31"});
}

// Of two channels whose chirps are alike, the maps of all chirps are the truth.
TEST(RangeDoppler, PowersOfWhatRestsAreThoseOfRepeatedChirps) {
  const Radar radar = small_radar(1, 2);
  const std::vector<Complex> cube = tones(radar, 3.3, 0.0);
  const MapWindows window = Window{WindowKind::kHann};
  const std::vector<double> mean = mean_power(range_doppler(cube, radar, window, 2));
  const MapTransform map(radar, window, 2);
  std::vector<double> still(static_cast<size_t>(map.num_ranges())), cells(mean.size());
  for (size_t channel = 0; channel < 2; ++channel) map.add_still(cube.data() + channel * cube.size() / 2, still);
  map.spread_still(still, cells.data());
  for (size_t i = 0; i < cells.size(); ++i) ASSERT_NEAR(0.5 * cells[i], mean[i], kRounding) << i;
}

}  // namespace
}  // namespace echopath::test_range_doppler
