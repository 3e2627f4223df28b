#include <gtest/gtest.h>

#include <cmath>

#include "cpp/signal/slow_sum.h"
#include "cpp/support/any_threads.h"
#include "echopath/signal/noise.h"

namespace echopath::test_noise {
namespace {

using testing::Complex;

constexpr double kLastDigitDb = 1e-3;  // as printed
constexpr double kSampledDb = 0.1;     // of as many samples as there are in a frame

Radar noisy_radar(bool real) {
  Radar radar;
  radar.waveform = testing::reference_waveform();
  radar.waveform.num_chirps = 256;
  radar.waveform.real = real;
  radar.transmitters.resize(1);
  radar.receivers.resize(1);
  return radar;
}

std::vector<Complex> noise(const Radar& radar, uint64_t seed) {
  std::vector<Complex> cube(cube_size(radar));
  add_noise(cube, radar, seed);
  return cube;
}

double mean_power(const std::vector<Complex>& cube) {
  double sum = 0.0;
  for (const Complex& sample : cube) sum += std::norm(sample);
  return sum / static_cast<double>(cube.size());
}

double dbm(double watts) { return 10 * std::log10(watts) + 30; }

TEST(Noise, PowerIsTheThermalOne) {
  EXPECT_NEAR(dbm(noise_power(noisy_radar(false))), -88.965, kLastDigitDb);
  EXPECT_NEAR(dbm(noise_power(noisy_radar(true))), -91.975, kLastDigitDb);
  EXPECT_NEAR(dbm(mean_power(noise(noisy_radar(false), 1))), -88.965, kSampledDb);
  EXPECT_NEAR(dbm(mean_power(noise(noisy_radar(true), 1))), -91.975, kSampledDb);
}

TEST(Noise, IsCircularGaussianAndWhite) {
  const auto cube = noise(noisy_radar(false), 3);
  const double n = static_cast<double>(cube.size()), power = mean_power(cube);
  Complex mean, pseudo, neighbour, below;
  double fourth = 0.0;
  for (size_t i = 0; i < cube.size(); ++i) {
    mean += cube[i];
    pseudo += cube[i] * cube[i];
    fourth += std::norm(cube[i]) * std::norm(cube[i]);
    if (i >= 1) neighbour += cube[i] * std::conj(cube[i - 1]);
    if (i >= 512) below += cube[i] * std::conj(cube[i - 512]);
  }
  const double five_sigma = 5.0 / std::sqrt(n);
  EXPECT_LT(std::abs(mean) / n / std::sqrt(power), five_sigma);
  EXPECT_LT(std::abs(pseudo) / n / power, 2 * five_sigma);
  EXPECT_LT(std::abs(neighbour) / n / power, five_sigma);
  EXPECT_LT(std::abs(below) / n / power, five_sigma);
  EXPECT_NEAR(fourth / n / (power * power), 2.0, 5.0 * std::sqrt(20.0 / n));  // exponential power
}

TEST(Noise, RealSamplesStayReal) {
  for (const Complex& sample : noise(noisy_radar(true), 1)) EXPECT_EQ(sample.imag(), 0.0);
}

TEST(Noise, DependsOnTheSeedAndNotOnThreads) {
  const Radar radar = noisy_radar(false);
  const auto one = test::same_on_any_threads([&] { return noise(radar, 5); });
  const auto other = noise(radar, 6);
  Complex correlation;
  for (size_t i = 0; i < one.size(); ++i) correlation += one[i] * std::conj(other[i]);
  const double n = static_cast<double>(one.size());
  EXPECT_LT(std::abs(correlation) / n / mean_power(one), 5.0 / std::sqrt(n));
}

TEST(Noise, IsAddedToTheSignal) {
  const Radar radar = noisy_radar(false);
  std::vector<Complex> cube(cube_size(radar), Complex(1.0, 2.0));
  add_noise(cube, radar, 5);
  const auto alone = noise(radar, 5);
  for (size_t i = 0; i < cube.size(); i += 997) EXPECT_EQ(cube[i], Complex(1.0, 2.0) + alone[i]);
}

TEST(Noise, BadInputIsAnError) {
  std::vector<Complex> cube(10);
  EXPECT_THROW(add_noise(cube, noisy_radar(false), 1), std::invalid_argument);
  EXPECT_THROW(add_noise(cube, Radar{}, 1), std::invalid_argument);
}

}  // namespace
}  // namespace echopath::test_noise
