#include "echopath/base/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>

namespace echopath::test_random {
namespace {

using Counter = std::array<uint32_t, 4>;
constexpr uint32_t kOnes = std::numeric_limits<uint32_t>::max();

// Known answers of philox4x32, 10 rounds, published with the Random123 library.
TEST(Philox, PublishedAnswerForZeroCounterAndKey) {
  EXPECT_EQ(philox4x32({0, 0, 0, 0}, {0, 0}), (Counter{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
}

TEST(Philox, PublishedAnswerForAllOnes) {
  EXPECT_EQ(philox4x32({kOnes, kOnes, kOnes, kOnes}, {kOnes, kOnes}),
            (Counter{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
}

TEST(Philox, PublishedAnswerForDigitsOfPi) {
  EXPECT_EQ(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Counter{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Uniform, MatchesTheFirst53BitsOfThePublishedWords) {
  // Stream 0 exists for no purpose, so that seed 0, index 0, dimension 0 is the published zero vector.
  const auto [first, second] = uniform2(0, static_cast<Stream>(0), 0, 0);
  EXPECT_EQ(first, std::floor(std::ldexp(double(0x6627e8d5), 21) + std::ldexp(double(0xe169c58d), -11)) * 0x1p-53);
  EXPECT_EQ(second, std::floor(std::ldexp(double(0xbc57ac4c), 21) + std::ldexp(double(0x9b00dbd8), -11)) * 0x1p-53);
}

TEST(Uniform, LiesInTheHalfOpenUnitIntervalWithMeanAndVarianceOfTheUniformLaw) {
  constexpr int kDraws = 200000;
  // Five standard errors of the mean (sigma = sqrt(1/12)) and of the variance (sigma^2 = 1/180) of that many draws.
  const double mean_tolerance = 5.0 * std::sqrt(1.0 / 12.0 / (2.0 * kDraws));
  const double variance_tolerance = 5.0 * std::sqrt(1.0 / 180.0 / (2.0 * kDraws));
  double sum = 0.0, sum_of_squares = 0.0;
  for (uint64_t i = 0; i < kDraws; ++i) {
    for (const double u : uniform2(7, Stream::kBounce, i, 3)) {
      ASSERT_GE(u, 0.0);
      ASSERT_LT(u, 1.0);
      sum += u;
      sum_of_squares += (u - 0.5) * (u - 0.5);
    }
  }
  EXPECT_NEAR(sum / (2.0 * kDraws), 0.5, mean_tolerance);
  EXPECT_NEAR(sum_of_squares / (2.0 * kDraws), 1.0 / 12.0, variance_tolerance);
}

TEST(Uniform, EverySeedStreamIndexAndDimensionGivesOtherNumbers) {
  constexpr uint64_t kHighBit = uint64_t{1} << 40;  // above the low word of seed and index
  const auto base = uniform2(1, Stream::kPhase, 5, 2);
  EXPECT_NE(base, uniform2(2, Stream::kPhase, 5, 2));
  EXPECT_NE(base, uniform2(1 + kHighBit, Stream::kPhase, 5, 2));
  EXPECT_NE(base, uniform2(1, Stream::kNoise, 5, 2));
  EXPECT_NE(base, uniform2(1, Stream::kPhase, 6, 2));
  EXPECT_NE(base, uniform2(1, Stream::kPhase, 5 + kHighBit, 2));
  EXPECT_NE(base, uniform2(1, Stream::kPhase, 5, 3));
  EXPECT_EQ(base, uniform2(1, Stream::kPhase, 5, 2));
}

}  // namespace
}  // namespace echopath::test_random
