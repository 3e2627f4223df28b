// Phases of products of many turns, beside long double.
#include "echopath/base/lanes/phasor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace echopath::test_phasor {
namespace {

constexpr double kTolerance = 5e-15;  // 5e-16 of the polynomial, and roundings of the rest of a turn, each up to 2^-53 turns

// 24 bits times 40 bits: more than a double holds, and exact in the 64 bits of a long double.
TEST(PhasorOfProduct, IsThatOfLongDoubleForUpToATrillionTurns) {
  std::mt19937_64 random(7);
  std::uniform_int_distribution<int64_t> of_24_bits(1 << 23, (1 << 24) - 1);
  std::uniform_int_distribution<int64_t> of_40_bits(int64_t{1} << 39, (int64_t{1} << 40) - 1);
  double largest = 0.0;
  for (const int exponent : {0, 10, 20, 30, 40}) {  // turns below 2^exponent
    for (int i = 0; i < 2000; ++i) {
      const double a = std::ldexp(static_cast<double>(of_24_bits(random)), -24) * (i % 2 ? 1.0 : -1.0);
      const double b = std::ldexp(static_cast<double>(of_40_bits(random)), exponent - 40);
      const long double turns = static_cast<long double>(a) * b;
      const long double angle = 2.0L * std::numbers::pi_v<long double> * (turns - std::round(turns));
      const Phasor found = phasor_of_product(a, b);
      const long double error = std::max(std::abs(found.re - std::cos(angle)), std::abs(found.im - std::sin(angle)));
      largest = std::max(largest, static_cast<double>(error));
    }
  }
  EXPECT_LT(largest, kTolerance);
}

}  // namespace
}  // namespace echopath::test_phasor
