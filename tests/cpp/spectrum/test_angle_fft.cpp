#include <gtest/gtest.h>

#include <algorithm>

#include "cpp/support/any_threads.h"
#include "echopath/spectrum/angle/angle_fft.h"
#include "echopath/spectrum/array/virtual_array.h"
#include "plane_waves.h"

namespace echopath::test_angle_fft {
namespace {

using testing::Complex;
using testing::kDegree;
constexpr double kRounding = 1e-12;  // of unit waves

const Window kRect{WindowKind::kRect};
const double kHalf = 0.5 * testing::wavelength();

Complex value(const AngleSpectrum& s, size_t elevation, size_t azimuth, size_t velocity, size_t range) {
  return s.values[((elevation * s.sin_azimuth.size() + azimuth) * s.velocity.size() + velocity) * s.range.size() + range];
}

// sin(N x / 2) / (N sin(x / 2))
double dirichlet(int n, double x) {
  return std::abs(std::sin(0.5 * x)) < 1e-15 ? 1.0 : std::sin(0.5 * n * x) / (n * std::sin(0.5 * x));
}

TEST(AngleFft, LineOfTwelveGivesTheDirichletKernel) {
  const Radar radar = testing::line_radar(12);
  RangeDoppler map = testing::empty_map(radar);
  const double left = 20.0 * kDegree;
  testing::add_wave(map, radar, direction(left, 0.0), 2.0, 3, 1);
  const AngleSpectrum s = angle_fft(map, radar, {.window = kRect, .zero_pad = 8});
  ASSERT_EQ(s.sin_azimuth.size(), 96u);
  ASSERT_EQ(s.sin_elevation, std::vector<double>{0.0});
  EXPECT_NEAR(s.sin_azimuth.front(), -1.0, kRounding);
  for (size_t i = 0; i < s.sin_azimuth.size(); ++i) {
    const double expected = 2.0 * dirichlet(12, kPi * (s.sin_azimuth[i] - std::sin(left)));
    // Referred to the centre of the array the field is real times the wave's phase there.
    const Complex at_centre = std::polar(1.0, -kTwoPi / testing::wavelength() * 5.5 * kHalf * std::sin(left));
    EXPECT_NEAR(std::abs(value(s, 0, i, 3, 1) - expected * at_centre), 0.0, kRounding);
    EXPECT_EQ(value(s, 0, i, 2, 1), Complex());
  }
}

// Slow sum over all channels, each with the weight of its element.
Complex slow(const RangeDoppler& map, const Radar& radar, const VirtualArray& array, const Vec3& u, size_t velocity,
             size_t range) {
  const double k = kTwoPi / array.wavelength;
  Complex sum;
  for (const VirtualElement& element : array.elements) {
    Complex mean;
    for (const int channel : element.channels) {
      const double delay = channel / array.num_receivers * radar.waveform.chirp_interval;
      const double slot = 2.0 * k * map.velocity[velocity] * delay;
      mean += map.values[(channel * map.velocity.size() + velocity) * map.range.size() + range] * std::polar(1.0, -slot);
    }
    mean /= static_cast<double>(element.channels.size());
    sum +=
        mean * std::polar(1.0, k * (element.position - array.centre()).dot(u)) / static_cast<double>(array.elements.size());
  }
  return sum;
}

TEST(AngleFft, EqualsTheSlowSumOnAGridWithGapsAndOverlaps) {
  const Radar radar = testing::radar_with({{0, 0, 1}, {0, 2 * kHalf, 1}, {0, kHalf, 1 + 2.6 * kHalf}},
                                          {{0, 0, 1}, {0, kHalf, 1}, {0, 2 * kHalf, 1}, {0, 5 * kHalf, 1 + 1.3 * kHalf}});
  const VirtualArray array = virtual_array(radar);
  ASSERT_TRUE(array.grid);
  ASSERT_GT(array.num_overlaps(), 0);
  ASSERT_FALSE(array.gaps().empty());
  RangeDoppler map = testing::empty_map(radar);
  for (size_t i = 0; i < map.values.size(); ++i) map.values[i] = std::polar(1.0, 1.7 * static_cast<double>(i * i % 97));
  const AngleSpectrum s = angle_fft(map, radar, {.window = kRect, .zero_pad = 2});
  int compared = 0;
  for (size_t e = 0; e < s.sin_elevation.size(); ++e) {
    for (size_t a = 0; a < s.sin_azimuth.size(); ++a) {
      const double up = s.sin_elevation[e], left = s.sin_azimuth[a];
      if (up * up + left * left > 1.0) continue;
      const Vec3 u(std::sqrt(1.0 - up * up - left * left), left, up);
      EXPECT_NEAR(std::abs(value(s, e, a, 5, 2) - slow(map, radar, array, u, 5, 2)), 0.0, kRounding);
      ++compared;
    }
  }
  EXPECT_GT(compared, 50);
}

TEST(AngleFft, LeftAndUpArePositive) {
  std::vector<Vec3> receivers;
  for (int i = 0; i < 16; ++i) receivers.emplace_back(0.0, i % 4 * kHalf, i / 4 * kHalf);
  const Radar radar = testing::radar_with({Vec3::Zero()}, receivers);
  RangeDoppler map = testing::empty_map(radar);
  const Vec3 u(std::sqrt(1.0 - 0.25 - 0.0625), 0.5, -0.25);  // left and down, both on the grid of the transform
  testing::add_wave(map, radar, u, 1.0, 0, 0);
  const AngleSpectrum s = angle_fft(map, radar, {.window = kRect, .zero_pad = 2});
  const auto peak = std::max_element(s.values.begin(), s.values.end(),
                                     [](const Complex& a, const Complex& b) { return std::norm(a) < std::norm(b); });
  const size_t cell = (peak - s.values.begin()) / (s.velocity.size() * s.range.size());
  EXPECT_EQ(s.sin_azimuth[cell % s.sin_azimuth.size()], 0.5);
  EXPECT_EQ(s.sin_elevation[cell / s.sin_azimuth.size()], -0.25);
  EXPECT_NEAR(std::norm(*peak), 1.0, kRounding);
}

TEST(AngleFft, EveryWindowKeepsThePowerOfAPoint) {
  const Radar radar = testing::line_radar(8);
  RangeDoppler map = testing::empty_map(radar);
  testing::add_wave(map, radar, direction(std::asin(0.25), 0.0), 3.0, 4, 2);
  for (const auto kind : {WindowKind::kRect, WindowKind::kHann, WindowKind::kHamming, WindowKind::kBlackman,
                          WindowKind::kBlackmanHarris, WindowKind::kChebyshev, WindowKind::kTaylor, WindowKind::kKaiser}) {
    const AngleSpectrum s = angle_fft(map, radar, {.window = {kind, 40.0}});
    double peak = 0.0;
    for (const Complex& field : s.values) peak = std::max(peak, std::norm(field));
    EXPECT_NEAR(peak, 9.0, 9.0 * kRounding) << static_cast<int>(kind);
  }
}

TEST(AngleFft, WindowsOfArraysAreSymmetricAndNowhereZero) {
  for (const auto kind : {WindowKind::kHann, WindowKind::kHamming, WindowKind::kBlackman, WindowKind::kBlackmanHarris,
                          WindowKind::kChebyshev, WindowKind::kTaylor, WindowKind::kKaiser}) {
    for (const int n : {2, 3, 8}) {
      const auto w = centred_window_samples({kind, 40.0}, n);
      for (int i = 0; i < n; ++i) {
        EXPECT_NEAR(w[i], w[n - 1 - i], kRounding);
        EXPECT_GT(w[i], 1e-6);
      }
    }
  }
}

// Noise in each channel: the mean over realisations is the sum of squared weights.
TEST(AngleFft, NoiseFallsByTheSumOfSquaredWeights) {
  const Vec3 step(0, kHalf, 0);
  const Radar radar = testing::radar_with(testing::line(2, 3 * step), testing::line(4, step));
  RangeDoppler map = testing::empty_map(radar);
  const std::vector<double> weights = element_weights(virtual_array(radar), {WindowKind::kHann});
  double expected = 0.0, mean = 0.0;
  for (size_t e = 0; e < weights.size(); ++e) expected += weights[e] * weights[e] / (e == 3 ? 2.0 : 1.0);
  // A unit impulse in one channel at a time: their powers add up like those of independent noise.
  for (size_t channel = 0; channel < 8; ++channel) {
    std::fill(map.values.begin(), map.values.end(), Complex());
    map.values[channel * map.velocity.size() * map.range.size()] = 1.0;
    mean += std::norm(value(angle_fft(map, radar), 0, 7, 0, 0));
  }
  EXPECT_NEAR(mean, expected, kRounding);
}

TEST(AngleFft, FirstOfOverlapsTakesTheFirst) {
  const Vec3 step(0, kHalf, 0);
  const Radar radar = testing::radar_with(testing::line(2, 3 * step), testing::line(4, step));
  RangeDoppler map = testing::empty_map(radar);
  map.values[4 * map.velocity.size() * map.range.size()] = 1.0;  // the second channel of element 3
  const AngleSpectrum first = angle_fft(map, radar, {.window = kRect, .overlaps = Overlaps::kFirst});
  const AngleSpectrum average = angle_fft(map, radar, {.window = kRect, .compensate = false});
  for (const Complex& field : first.values) EXPECT_EQ(field, Complex());
  EXPECT_NEAR(std::abs(value(average, 0, 5, 0, 0)), 0.5 / 7.0, kRounding);
}

TEST(AngleFft, NarrowStepsShowDirectionsThatDoNotExistAsNaN) {
  const AngleSpectrum s{{-1.25, -1.0, 0.0, 0.5}, {0.0}, {}, {}, {}};
  const std::vector<double> angles = angles_of(s.sin_azimuth);
  EXPECT_TRUE(std::isnan(angles[0]));
  EXPECT_NEAR(angles[1], -0.5 * kPi, kRounding);
  EXPECT_NEAR(angles[3], kPi / 6.0, kRounding);
}

TEST(AngleFft, OneChannelIsTheMapItself) {
  const Radar radar = testing::line_radar(1);
  RangeDoppler map = testing::empty_map(radar);
  testing::add_wave(map, radar, direction(0.4, 0.0), {1.0, 2.0}, 2, 3);
  const AngleSpectrum s = angle_fft(map, radar);
  EXPECT_EQ(s.sin_azimuth, std::vector<double>{0.0});
  EXPECT_EQ(s.values, map.values);
}

TEST(AngleFft, DoesNotDependOnTheNumberOfThreads) {
  const Radar radar = testing::line_radar(5, 8, 20);
  RangeDoppler map = testing::empty_map(radar);
  for (size_t i = 0; i < map.values.size(); ++i) map.values[i] = std::polar(1.0, 0.1 * static_cast<double>(i * i % 61));
  test::same_on_any_threads([&] { return angle_fft(map, radar).values; });
}

TEST(AngleFft, BadInputIsAnError) {
  const Radar radar = testing::line_radar(3);
  const RangeDoppler map = testing::empty_map(radar);
  for (const int zero_pad : {0, 65}) {
    EXPECT_THROW(angle_fft(map, radar, {.window = kRect, .zero_pad = zero_pad}), std::invalid_argument);
  }
  EXPECT_THROW(angle_fft(map, testing::line_radar(4)), std::invalid_argument);
  const Radar circle = testing::circle_radar();
  EXPECT_THROW(angle_fft(testing::empty_map(circle), circle), std::invalid_argument);
  Job job;
  job.cancel();
  EXPECT_THROW(angle_fft(map, radar, {}, &job), Cancelled);
}

}  // namespace
}  // namespace echopath::test_angle_fft
