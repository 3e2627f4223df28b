// Ten million random materials, angles and cells: nothing is ever NaN or infinite, and no surface reflects more than it
// gets.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "cpp/em/footprints.h"
#include "cpp/support/sanitized.h"
#include "echopath/base/random.h"
#include "echopath/em/surface/surface_response.h"

namespace echopath::test_random_draws {
namespace {

using namespace testing;

// Sanitizers look at the same lines at each draw.
const uint64_t kDraws = test::kIsSanitized ? 500'000 : 3'000'000;
constexpr double kRounding = 1e-12;  // of |Gamma|^2 against 1

// From 10^-low to 10^high, evenly in the exponent.
double decades(double unit, double low, double high) { return std::pow(10.0, low + unit * (high - low)); }

TEST(RandomDraws, ReflectionIsFiniteAndPassive) {
  int64_t num_bad = 0;
  for (uint64_t i = 0; i < kDraws; ++i) {
    const auto a = uniform2(11, Stream::kBounce, i, 0), b = uniform2(11, Stream::kBounce, i, 1);
    Material material;
    material.permittivity = std::complex<double>(decades(a[0], -6, 9), i % 3 == 0 ? 0.0 : -decades(a[1], -12, 9));
    material.conductivity = i % 5 == 0 ? decades(b[0], -9, 9) : 0.0;
    const double cos_incidence = i % 2 == 0 ? b[1] : decades(b[1], -9, 0);
    for (const PolarizationMode mode : {PolarizationMode::kTe, PolarizationMode::kTm}) {
      const double power = std::norm(respond(material, 77e9, cos_incidence, mode).gamma);
      if (!(power <= 1.0 + kRounding)) ++num_bad;  // NaN fails too
    }
  }
  EXPECT_EQ(num_bad, 0);
}

TEST(RandomDraws, FootprintsAreFiniteAndNoGain) {
  int64_t num_bad = 0;
  for (uint64_t i = 0; i < kDraws; ++i) {
    const auto a = uniform2(12, Stream::kBounce, i, 0), b = uniform2(12, Stream::kBounce, i, 1),
               c = uniform2(12, Stream::kBounce, i, 2);
    const auto draw = [](double unit) { return (unit < 0.5 ? -1.0 : 1.0) * decades(std::abs(2 * unit - 1), -6, 6); };
    const FootprintPhase phase{draw(a[0]), draw(a[1]), draw(b[0]), draw(b[1]), draw(c[0])};
    if (!(std::abs(second_order(phase, 0.3 + c[1])) <= 1.0 + kRounding)) ++num_bad;
    if (!(flat_top(phase) <= 1.0) || !(first_order(phase) <= 1.0)) ++num_bad;
  }
  EXPECT_EQ(num_bad, 0);
}

}  // namespace
}  // namespace echopath::test_random_draws
