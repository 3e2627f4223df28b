#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <thread>
#include <vector>

#include "echopath/fft/fft.h"

namespace echopath::test_fft {
namespace {

constexpr double kRounding = 1e-13;  // relative to the sum of magnitudes, eps log2(size) with room

FftBuffer test_signal(int size) {
  FftBuffer buffer(size);
  for (int n = 0; n < size; ++n) buffer[n] = {std::cos(0.7 * n * n), std::sin(1.3 * n)};
  return buffer;
}

std::complex<double> slow_bin(const FftBuffer& signal, int bin, double sign) {
  std::complex<double> sum;
  const int64_t size = signal.size();
  for (int64_t n = 0; n < size; ++n) {
    const double turn = static_cast<double>(n * bin % size) / static_cast<double>(size);
    sum += signal[n] * std::polar(1.0, sign * 2.0 * std::numbers::pi * turn);
  }
  return sum;
}

TEST(Fft, BothDirectionsEqualTheSlowSum) {
  for (const int size : {1, 2, 7, 60, 512}) {
    for (const auto direction : {FftDirection::kForward, FftDirection::kBackward}) {
      const FftBuffer signal = test_signal(size);
      FftBuffer buffer = test_signal(size);
      Fft(size, direction).transform(buffer);
      const double sign = direction == FftDirection::kForward ? -1.0 : 1.0;
      for (int k = 0; k < size; ++k) {
        EXPECT_NEAR(std::abs(buffer[k] - slow_bin(signal, k, sign)), 0.0, kRounding * 2 * size) << size << " " << k;
      }
    }
  }
}

TEST(Fft, PlansAreMadeAndUsedFromManyThreads) {
  FftBuffer expected = test_signal(96);
  Fft(96, FftDirection::kForward).transform(expected);
  std::vector<int> equal(8, 0);
  std::vector<std::thread> threads;
  for (int i = 0; i < 8; ++i) {
    threads.emplace_back([&, i] {
      for (int repeat = 0; repeat < 20; ++repeat) {
        FftBuffer buffer = test_signal(96);
        Fft(96, FftDirection::kForward).transform(buffer);
        equal[i] += std::equal(buffer.data(), buffer.data() + 96, expected.data());
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const int count : equal) EXPECT_EQ(count, 20);
}

TEST(Fft, BadSizesAreErrors) {
  EXPECT_THROW(Fft(0, FftDirection::kForward), std::invalid_argument);
  EXPECT_THROW(FftBuffer(0), std::invalid_argument);
  FftBuffer buffer(4);
  EXPECT_THROW(Fft(5, FftDirection::kForward).transform(buffer), std::invalid_argument);
}

TEST(Fft, FastSizesHaveSmallFactors) {
  EXPECT_EQ(fast_fft_size(1), 1);
  EXPECT_EQ(fast_fft_size(7), 8);
  EXPECT_EQ(fast_fft_size(1024), 1024);
  EXPECT_EQ(fast_fft_size(1025), 1080);
}

}  // namespace
}  // namespace echopath::test_fft
