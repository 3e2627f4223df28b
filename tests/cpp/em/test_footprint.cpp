// Footprint filters against numerical integrals.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <random>

#include "cpp/em/footprints.h"
#include "echopath/base/constants.h"

namespace echopath::test_footprint {
namespace {

using namespace testing;

constexpr double kSum = 1e-12;        // of a sum of 1.6e5 terms, which is exact to rounding
constexpr double kThreeSums = 1e-11;  // of three of them, whose weights add up to 7
constexpr double kRounding = 1e-15;
constexpr double kAnyRounding = 1e-8;       // relative, of phases of g^2 / h where 1 / h has lost digits
constexpr double kStep = 0.05;              // of 1, between curvatures that differ by 2 %
constexpr double kFlat = 1e-3;              // what cells that turn by a tenth of a cycle may lose
constexpr double kFlatTop = 1e-4;           // likewise, at half a radian
constexpr double kFaded = 1e-6;             // of cells that turn by two cycles
constexpr double kSmallCell = 1e-5;         // of the first order in phases of 1e-5
constexpr double kSmallCellSquared = 1e-9;  // of their second order

std::complex<double> edges(const FootprintPhase& phase, double spread) {
  const ComplexOf<double> found = edges_footprint_of<ScalarMath>(phase, spread);
  return {found.re, found.im};
}

// Trapezoidal sum over +-9 standard deviations: exact to rounding for a Gaussian times a resolved phase.
std::complex<double> gaussian_mean(const FootprintPhase& phase, double spread) {
  constexpr int kSteps = 400;
  const double reach = 9.0 * spread, step = 2.0 * reach / kSteps;
  std::complex<double> sum = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      const double x = -reach + i * step, y = -reach + j * step;
      const double angle =
          phase.g1 * x + phase.g2 * y + 0.5 * (phase.h11 * x * x + 2 * phase.h12 * x * y + phase.h22 * y * y);
      sum += std::exp(-0.5 * (x * x + y * y) / (spread * spread)) * std::polar(1.0, -angle);
    }
  }
  return sum * step * step / (kTwoPi * spread * spread);
}

TEST(Footprint, SecondOrderIsTheGaussianIntegral) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> slope(-4.0, 4.0), curvature(-6.0, 6.0);
  for (int i = 0; i < 40; ++i) {
    const FootprintPhase phase{slope(random), slope(random), curvature(random), curvature(random), curvature(random)};
    EXPECT_LT(std::abs(second_order(phase, 0.6) - gaussian_mean(phase, 0.6)), kSum);
  }
}

TEST(Footprint, SecondOrderIsContinuousAndBoundedForLargeCurvature) {
  for (const double sign : {-1.0, 1.0}) {
    std::complex<double> before = 1.0;
    for (double h = 0.0; h < 2000.0; h = h * 1.02 + 1e-3) {
      const std::complex<double> now = second_order({0.3, -0.2, sign * h, 0.1 * h, sign * 0.7 * h}, 0.6);
      EXPECT_LE(std::abs(now), 1.0 + kRounding);
      EXPECT_LT(std::abs(now - before), kStep);
      before = now;
    }
  }
}

// Along the axes of its curvature the footprint is a product of two integrals in closed form, whatever the size of the cell.
TEST(Footprint, SecondOrderIsTheProductOfBothAxesForCellsOfAnySize) {
  constexpr double kSpread = 0.6, kVariance = kSpread * kSpread;
  for (const double h1 : {1e3, -1e6, 1e8, 1e9, -1e12}) {
    for (const double h2 : {0.5, -2e3, 1e6, 1e8, 1e9, 1e12}) {
      const FootprintPhase phase{2.0, -3.0, h1, 0.0, h2};
      std::complex<double> expected = 1.0;
      for (const auto& [g, h] : {std::pair(2.0, h1), std::pair(-3.0, h2)}) {
        const std::complex<double> width(1.0, kVariance * h);
        expected *= std::exp(-0.5 * kVariance * g * g / width) / std::sqrt(width);
      }
      EXPECT_LT(std::abs(second_order(phase, kSpread) - expected), kAnyRounding * std::abs(expected)) << h1 << " " << h2;
    }
  }
}

// Matrices that are singular to rounding, as they come behind several curved bounces, filter nothing up.
TEST(Footprint, IsBoundedWhereItsMatrixIsSingularToRounding) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < 100000; ++i) {
    const double size = std::pow(10.0, 8.0 + 6.0 * unit(random)), x = unit(random), y = unit(random);
    const FootprintPhase phase{size * x, size * y, size * x * x, size * x * y, size * y * y * (1.0 + 1e-15 * unit(random))};
    ASSERT_LE(std::abs(second_order(phase, 0.65)), 1.0 + kRounding) << i;
    ASSERT_TRUE(std::isfinite(std::abs(edges(phase, 0.65)))) << i;
  }
}

TEST(Footprint, EdgesCombineThreeGaussians) {
  const FootprintPhase phase{0.7, -0.4, 0.5, 0.2, -0.3};
  const auto mean = [&](double times) { return gaussian_mean(phase, 0.6 * std::sqrt(times)); };
  EXPECT_LT(std::abs(edges(phase, 0.6) - (3.0 * mean(1.0) - 3.0 * mean(2.0) + mean(3.0))), kThreeSums);
  EXPECT_LT(std::abs(edges({0.2 * kPi, 0, 0, 0, 0}, 0.65) - 1.0), kFlat);
  EXPECT_LT(std::abs(edges({12.0, 0, 0, 0, 0}, 0.65)), kFaded);
}

TEST(Footprint, AllTendToOneForSmallCells) {
  const FootprintPhase small{1e-5, -2e-5, 1e-5, 3e-6, -1e-5};
  EXPECT_NEAR(first_order(small), 1.0, kSmallCellSquared);
  EXPECT_NEAR(flat_top(small), 1.0, kRounding);
  EXPECT_LT(std::abs(second_order(small, 0.6) - 1.0), kSmallCell);
}

// sinc(g/2) = 1 - g^2/24 + ... : the Gaussian is its fit.
TEST(Footprint, FirstOrderFitsTheShapeFactorOfASquareCell) {
  for (const double g : {0.1, 0.5, 1.0}) {
    const double sinc = std::sin(0.5 * g) / (0.5 * g);
    EXPECT_NEAR(first_order({g, 0, 0, 0, 0}), sinc, 4e-4 * std::pow(g, 4));
  }
}

TEST(Footprint, FlatTopIsFlat) {
  EXPECT_GT(flat_top({0.5, 0.5, 0, 0, 0}), 1.0 - kFlatTop);
  EXPECT_LT(flat_top({12.0, 0, 0, 0, 0}), kFaded);
}

// |integral of e^{-j(g.x + x.h.x/2)} over a square of cells about the middle|, by midpoints.
double integral_over(const FootprintPhase& phase, double from, double to) {
  constexpr int kSteps = 2000;
  const double step = (to - from) / kSteps;
  std::complex<double> sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const double x = from + (i + 0.5) * step, y = from + (j + 0.5) * step;
      sum += std::polar(
          1.0, -(phase.g1 * x + phase.g2 * y + 0.5 * (phase.h11 * x * x + 2 * phase.h12 * x * y + phase.h22 * y * y)));
    }
  }
  return std::abs(sum) * step * step;
}

// Axes turned by an angle.
FootprintPhase turned(const FootprintPhase& phase, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * phase.g1 - s * phase.g2, s * phase.g1 + c * phase.g2,
          c * c * phase.h11 - 2 * c * s * phase.h12 + s * s * phase.h22,
          c * s * (phase.h11 - phase.h22) + (c * c - s * s) * phase.h12,
          s * s * phase.h11 + 2 * c * s * phase.h12 + c * c * phase.h22};
}

double of_points(const FootprintPhase& phase) { return between_rays_of<ScalarMath>(phase).points; }
double of_edges(const FootprintPhase& phase) { return between_rays_of<ScalarMath>(phase).edges; }

// A point of reflection beside the middle of a cell, where a Gaussian about the middle sees nearly nothing of it: what it
// sends back is that of all cells together, the ends of the integral apart.
TEST(Footprint, BetweenRaysIsAPointOfReflectionInTheCell) {
  const FootprintPhase bent{0.6 * 60.0, -0.5 * 50.0, 60.0, 0.0, -50.0};
  const double whole = integral_over(bent, -3.0, 3.0);
  EXPECT_NEAR(of_points(bent) / whole, 1.0, 0.1);
  EXPECT_EQ(of_edges(bent), 0.0);
  EXPECT_LT(std::abs(second_order(bent, 0.65)), 0.8 * whole);
  for (const double angle : {0.3, 1.1, 2.5}) EXPECT_NEAR(of_points(turned(bent, angle)) / of_points(bent), 1.0, kThreeSums);
}

// |integral of e^{-j(gx + hx^2/2)} from -1/2 to the edge|, at its most over the places of the edge.
double most_of_a_cut(double slope, double bend) {
  constexpr int kSteps = 20000;
  std::complex<double> sum = 0.0;
  double most = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double x = (i + 0.5) / kSteps - 0.5;
    sum += std::polar(1.0 / kSteps, -(slope * x + 0.5 * bend * x * x));
    most = std::max(most, std::abs(sum));
  }
  return most;
}

// Without a point of reflection a cell that an edge cuts sends back what its part does, whichever that is.
TEST(Footprint, BetweenRaysBoundsACellThatAnEdgeCuts) {
  for (const double slope : {4.0, 12.0, 45.0}) {
    const FootprintPhase level{slope, 0.0, 0.1, 0.0, 0.1};
    EXPECT_EQ(of_points(level), 0.0);
    EXPECT_GT(of_edges(level), 0.8 * most_of_a_cut(slope, 0.1));
    EXPECT_LT(of_edges(level), 1.01 * most_of_a_cut(slope, 0.1));
  }
}

// Bent along one axis, with the line of stationary phase beside the middle, and cut across the other one.
TEST(Footprint, BetweenRaysBoundsALineThatAnEdgeCuts) {
  const FootprintPhase line{36.0, 12.0, 60.0, 0.0, 0.1};
  const double along = integral_over({36.0, 0.0, 60.0, 0.0, 0.1}, -3.0, 3.0) / 6.0;  // its other axis counts six cells
  for (const double angle : {0.0, 0.7, 2.0}) {
    EXPECT_NEAR(of_edges(turned(line, angle)) / (along * most_of_a_cut(12.0, 0.1)), 1.0, 0.1);
  }
}

TEST(Footprint, NothingIsBetweenRaysThatFollowThePhase) {
  EXPECT_LT(of_edges({0.3, -0.2, 0.2, 0.05, 0.1}) + of_points({0.3, -0.2, 0.2, 0.05, 0.1}), 0.02);
}

}  // namespace
}  // namespace echopath::test_footprint
