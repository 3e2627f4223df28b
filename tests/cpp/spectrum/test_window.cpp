#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

#include "cpp/support/expect_error.h"
#include "echopath/spectrum/window.h"

namespace echopath::test_window {
namespace {

constexpr double kPrinted = 1e-4;    // of figures printed with four decimals
constexpr double kPrintedDb = 1e-2;  // likewise, with two
constexpr double kRounding = 1e-15;

double sum_of(const std::vector<double>& samples) { return std::accumulate(samples.begin(), samples.end(), 0.0); }

double level_db(const std::vector<double>& w, double bin) {
  std::complex<double> sum;
  double total = 0.0;
  for (size_t i = 0; i < w.size(); ++i) {
    const double angle = -2.0 * std::numbers::pi * bin * static_cast<double>(i) / static_cast<double>(w.size());
    sum += w[i] * std::polar(1.0, angle);
    total += w[i];
  }
  return 20.0 * std::log10(std::abs(sum) / total);
}

// Harris' figures for 512 points, to their printed digits: of those with two, to one in the last.
TEST(Window, FiguresOfMeritAreThePublishedOnes) {
  struct Row {
    Window window;
    double gain, bandwidth, scalloping;
    double printed = kPrinted, printed_db = kPrintedDb;
  };
  const Row rows[] = {{{WindowKind::kRect}, 1, 1, 3.92},
                      {{WindowKind::kHann}, .5, 1.5, 1.42},
                      {{WindowKind::kHamming}, .54, 1.3628, 1.75},
                      {{WindowKind::kChebyshev, 80}, .4137, 1.7446, 1.09},
                      {{WindowKind::kChebyshev, 100}, .3697, 1.9441, .88},
                      {{WindowKind::kBlackmanHarris}, .3588, 2.0044, .83},
                      {{WindowKind::kBlackman}, .42, 1.73, 1.10, .01, .01},
                      {{WindowKind::kKaiser, 46}, .49, 1.50, 1.46, .01, .03},
                      {{WindowKind::kKaiser, 57}, .44, 1.65, 1.20, .01, .03},
                      {{WindowKind::kKaiser, 69}, .40, 1.80, 1.02, .01, .03},
                      {{WindowKind::kKaiser, 82}, .37, 1.93, .89, .01, .03}};
  for (const Row& row : rows) {
    const auto w = window_samples(row.window, 512);
    const int kind = static_cast<int>(row.window.kind);
    EXPECT_NEAR(sum_of(w) / 512, row.gain, row.printed) << kind;
    EXPECT_NEAR(equivalent_noise_bandwidth(w), row.bandwidth, row.printed) << kind;
    EXPECT_NEAR(-level_db(w, 0.5), row.scalloping, row.printed_db) << kind;
  }
}

TEST(Window, ChebyshevSidelobesAreEqualAndAsAskedFor) {
  for (const int n : {64, 129}) {
    for (const double level : {40.0, 80.0, 120.0}) {
      const auto w = window_samples({WindowKind::kChebyshev, level}, n);
      double worst = -1e9;
      for (double bin = 0.15 * level; bin < 0.5 * n; bin += 0.01) worst = std::max(worst, level_db(w, bin));
      EXPECT_NEAR(worst, -level, 0.05) << n;  // the grid of 0.01 bins meets a lobe's top within 0.01 dB
    }
  }
}

// Taylor, "Design of line-source antennas for narrow beamwidth and low side lobes", 1955: null k of the pattern.
double taylor_null(double level, int lobes, int k) {
  if (k >= lobes) return k;
  const double a = std::acosh(std::pow(10.0, level / 20.0)) / std::numbers::pi;
  return lobes * std::hypot(a, k - 0.5) / std::hypot(a, lobes - 0.5);
}

// Tables of the pattern have 4 equal lobes at 30 dB, 6 at 35, 7 at 40.
TEST(Window, TaylorHasThePublishedNulls) {
  for (const auto& [level, lobes] : {std::pair(30.0, 4), std::pair(35.0, 6), std::pair(40.0, 7)}) {
    const auto w = window_samples({WindowKind::kTaylor, level}, 1024);
    for (int k = 1; k < 3 * lobes; ++k) {
      const double null = taylor_null(level, lobes, k);
      EXPECT_LT(level_db(w, null), level_db(w, null + 0.45) - 40.0) << level << " " << k;
    }
  }
}

TEST(Window, TaylorSidelobesAreAsAskedForAndFall) {
  for (const int n : {64, 129}) {
    for (const auto& [level, lobes] : {std::pair(25.0, 4), std::pair(35.0, 6), std::pair(60.0, 13)}) {
      const auto w = window_samples({WindowKind::kTaylor, level}, n);
      double worst = -1e9, last = -1e9;
      for (double bin = taylor_null(level, lobes, 1); bin < 0.5 * n; bin += 0.01) worst = std::max(worst, level_db(w, bin));
      for (double bin = 0.4 * n; bin < 0.5 * n; bin += 0.01) last = std::max(last, level_db(w, bin));
      EXPECT_NEAR(worst, -level, 0.4) << n;  // the lobes that are moved stand a little lower
      EXPECT_LT(last, -level - 3.0) << n;
      EXPECT_GT(*std::ranges::min_element(w), 0.0) << n;
    }
  }
}

// What the comment on Window says of few samples.
TEST(Window, TaylorOfShortArraysMissesItsLevelByTwoDecibels) {
  for (const int n : {6, 8, 12}) {
    const auto w = window_samples({WindowKind::kTaylor, 30.0}, n);
    double worst = -1e9;
    for (double bin = taylor_null(30.0, 4, 1); bin <= 0.5 * n; bin += 0.01) worst = std::max(worst, level_db(w, bin));
    EXPECT_NEAR(worst, -30.0, 2.1) << n;
  }
}

// A published fit, good to half a decibel, gives the shape parameter for a level of the first sidelobe, which is the
// largest.
TEST(Window, KaisersFirstSidelobeIsAsAskedForAndTheOthersFall) {
  for (const int n : {65, 256}) {
    for (const double level : {20.0, 35.0, 60.0, 90.0, 120.0}) {
      const auto w = window_samples({WindowKind::kKaiser, level}, n);
      const double null = main_lobe_half_width(w);
      double worst = -1e9, last = -1e9;
      for (double bin = null; bin < null + 10.0; bin += 0.02) worst = std::max(worst, level_db(w, bin));
      for (double bin = 0.4 * n; bin < 0.5 * n; bin += 0.02) last = std::max(last, level_db(w, bin));
      EXPECT_NEAR(worst, -level, 1.0) << n;
      EXPECT_LT(last, -level - 10.0) << n;
    }
  }
}

TEST(Window, CosineWindowsArePeriodicAndOthersSymmetric) {
  for (const int n : {16, 17}) {
    for (const auto kind : {WindowKind::kHann, WindowKind::kHamming, WindowKind::kBlackman, WindowKind::kBlackmanHarris}) {
      const auto w = window_samples({kind}, n);
      for (int i = 1; i < n; ++i) EXPECT_NEAR(w[i], w[n - i], kRounding);
    }
    for (const auto kind : {WindowKind::kChebyshev, WindowKind::kTaylor, WindowKind::kKaiser}) {
      const auto w = window_samples({kind, 60.0}, n);
      for (int i = 0; i < n; ++i) EXPECT_NEAR(w[i], w[n - 1 - i], kRounding);
    }
  }
}

TEST(Window, ShortWindowsHaveAPositiveSum) {
  for (const auto kind : {WindowKind::kRect, WindowKind::kHann, WindowKind::kHamming, WindowKind::kBlackman,
                          WindowKind::kBlackmanHarris, WindowKind::kChebyshev, WindowKind::kTaylor, WindowKind::kKaiser}) {
    for (const int n : {1, 2, 3}) {
      EXPECT_GT(sum_of(window_samples({kind}, n)), 0.0) << static_cast<int>(kind) << " " << n;
    }
  }
}

TEST(Window, ThatAreTheSameAreEqualHoweverTheirLevelIsSaid) {
  EXPECT_EQ(Window::named("chebyshev"), Window::named("chebyshev", 80.0));
  EXPECT_EQ(Window::named("taylor"), Window::named("taylor", 35.0));
  EXPECT_NE(Window::named("taylor"), Window::named("taylor", 80.0));
  EXPECT_NE(Window::named("taylor", 80.0), Window::named("chebyshev", 80.0));
}

TEST(Window, BadValuesAreErrorsThatNameTheNearest) {
  EXPECT_THROW(window_samples({}, 0), std::invalid_argument);
  EXPECT_THROW(window_samples({WindowKind::kChebyshev, 5.0}, 8), std::invalid_argument);
  EXPECT_THROW(window_samples({WindowKind::kChebyshev, std::nan("")}, 8), std::invalid_argument);
  EXPECT_EQ(Window::named("hamming").kind, WindowKind::kHamming);
  test::expect_error<std::invalid_argument>([] { Window::named("chebychev"); }, {"nearest: chebyshev"});
}

}  // namespace
}  // namespace echopath::test_window
