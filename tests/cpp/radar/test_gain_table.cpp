// Gain tables against the closed forms they were sampled from.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "cpp/support/expect_error.h"
#include "echopath/base/constants.h"
#include "echopath/radar/radar.h"

namespace echopath::test_gain_table {
namespace {

using test::expect_error;

constexpr double kDegree = kPi / 180.0;
// Cubic Hermite with parabolic slopes errs in the third power of the step (0.087 rad for 5 degrees).
constexpr double kInterpolation = 1e-3;
constexpr double kRounding = 1e-12;
constexpr double kTurnedPattern = 0.02;  // rad and relative: tables in steps of 5 degrees, between their points

using Pattern = std::function<double(double azimuth, double elevation)>;

std::vector<double> axis(double first_deg, double last_deg, double step_deg) {
  std::vector<double> values;
  const long count = std::lround((last_deg - first_deg) / step_deg) + 1;
  for (long i = 0; i < count; ++i) values.push_back((first_deg + static_cast<double>(i) * step_deg) * kDegree);
  return values;
}

std::vector<double> sampled(const Pattern& pattern, const std::vector<double>& azimuth,
                            const std::vector<double>& elevation) {
  std::vector<double> samples;
  for (const double up : elevation) {
    for (const double along : azimuth) samples.push_back(pattern(along, up));
  }
  return samples;
}

GainTable table_of(const Pattern& gain, const std::vector<double>& azimuth, const std::vector<double>& elevation) {
  return GainTable(azimuth, elevation, sampled(gain, azimuth, elevation));
}

Vec3 toward(double azimuth, double elevation) {
  return Vec3(std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation), std::sin(elevation));
}

// Lossless, 2 (n + 1) cos^n of the angle from +x, n = 4: no edge at the rim of the half space.
double cosine4(double azimuth, double elevation) {
  return 10.0 * std::pow(std::max(0.0, toward(azimuth, elevation).x()), 4);
}

// Not symmetric in anything: left and up must not be taken for each other or for right and down.
double lopsided(double azimuth, double elevation) {
  const Vec3 u = toward(azimuth, elevation);
  return std::pow(0.5 + 0.2 * u.x() + 0.15 * u.y() - 0.1 * u.z(), 2);
}

TEST(GainTable, SamplesAreMetAndTheFieldBetweenThemIsSmooth) {
  const GainTable table = table_of(lopsided, axis(-180, 175, 5), axis(-90, 90, 5));
  for (const double azimuth : {-180.0, -177.3, -90.0, 0.0, 12.5, 91.7, 176.0, 179.99}) {
    for (const double elevation : {-90.0, -42.5, 0.0, 3.1, 88.0}) {
      const Vec3 u = toward(azimuth * kDegree, elevation * kDegree);
      EXPECT_NEAR(std::norm(table.field(u)), lopsided(azimuth * kDegree, elevation * kDegree), kInterpolation)
          << azimuth << " " << elevation;
    }
  }
  const double left = -35 * kDegree, up = 20 * kDegree;  // a sample
  EXPECT_NEAR(std::norm(table.field(toward(left, up))), lopsided(left, up), kRounding);
}

// A cubic field along the azimuth is a parabola in each slope: unequal steps must lose nothing.
TEST(GainTable, ParabolicFieldsAreExactOnUnequalSteps) {
  const std::vector<double> azimuth = {-0.9, -0.7, -0.2, -0.1, 0.3, 1.0}, elevation = {-0.4, 0.1, 0.2, 0.5};
  const auto field = [](double along, double up) {
    return 0.6 + 0.1 * along - 0.2 * along * along + 0.3 * up * up + 0.1 * up * along;
  };
  const GainTable table = table_of([&](double a, double e) { return std::pow(field(a, e), 2); }, azimuth, elevation);
  for (const double along : {-0.85, -0.3, 0.0, 0.1, 0.9}) {
    for (const double up : {-0.3, 0.15, 0.4}) {
      EXPECT_NEAR(std::abs(table.field(toward(along, up))), field(along, up), kRounding);
    }
  }
}

TEST(GainTable, IntegralIsThatOfTheClosedForm) {
  EXPECT_NEAR(table_of(cosine4, axis(-180, 180, 5), axis(-90, 90, 5)).efficiency(), 1.0, kInterpolation);
  EXPECT_NEAR(table_of(cosine4, axis(-90, 90, 5), axis(-90, 90, 5)).efficiency(), 1.0, kInterpolation);
  const Pattern isotropic = [](double, double) { return 0.8; };
  constexpr double kGauss = 1e-6;  // of three points on the cosine over 10 degrees
  EXPECT_NEAR(table_of(isotropic, axis(-180, 170, 10), axis(-90, 90, 10)).efficiency(), 0.8, kGauss);
  // A quarter of the azimuths, half of the sines of the elevation.
  EXPECT_NEAR(table_of(isotropic, axis(0, 90, 10), axis(-30, 30, 10)).efficiency(), 0.8 / 8, kGauss);
}

TEST(GainTable, MoreThanTheSphereIsAnError) {
  const Pattern decibel_off = [](double a, double e) { return 1.03 * cosine4(a, e); };
  EXPECT_THROW(table_of(decibel_off, axis(-90, 90, 5), axis(-90, 90, 5)), std::invalid_argument);
  const Pattern noisy = [](double a, double e) { return 1.01 * cosine4(a, e); };
  EXPECT_NO_THROW(table_of(noisy, axis(-90, 90, 5), axis(-90, 90, 5)));
}

TEST(GainTable, NormalizedTablesHaveAMeanOfOneAndAreThoseOfTheirOwnGain) {
  const auto azimuth = axis(-90, 90, 5), elevation = axis(-90, 90, 5);
  for (const double factor : {1e-6, 0.3, 1.0, 7.0}) {
    const Pattern scaled = [&](double a, double e) { return factor * cosine4(a, e); };
    const GainTable table(azimuth, elevation, sampled(scaled, azimuth, elevation), {}, GainTable::Scale::kMeanOfOne);
    EXPECT_NEAR(table.efficiency(), 1.0, 1e-12);
    EXPECT_NEAR(table.peak_gain(), 10.0, 0.02);  // of cos^4: 2 (4 + 1)
    const GainTable again(azimuth, elevation, table.gain());
    EXPECT_EQ(again.field(Vec3(0.8, 0.6, 0.0)), table.field(Vec3(0.8, 0.6, 0.0)));
  }
}

TEST(GainTable, ThereIsNoGainOutsideTheTable) {
  const GainTable table = table_of([](double, double) { return 1.0; }, axis(-60, 60, 10), axis(-20, 30, 10));
  EXPECT_EQ(table.field(toward(61 * kDegree, 0)), 0.0);
  EXPECT_EQ(table.field(toward(-61 * kDegree, 0)), 0.0);
  EXPECT_EQ(table.field(toward(0, 31 * kDegree)), 0.0);
  EXPECT_EQ(table.field(toward(0, -21 * kDegree)), 0.0);
  EXPECT_EQ(table.field(toward(kPi, 0)), 0.0);
  for (const double rim : {-60.0, 60.0}) EXPECT_NEAR(std::abs(table.field(toward(rim * kDegree, 0))), 1.0, kRounding);
}

TEST(GainTable, DarknessBehindIsThatOfTheCells) {
  EXPECT_TRUE(table_of(cosine4, axis(-90, 90, 5), axis(-90, 90, 5)).is_dark_behind());
  const GainTable whole = table_of(cosine4, axis(-180, 180, 5), axis(-90, 90, 5));
  EXPECT_TRUE(whole.is_dark_behind());
  EXPECT_EQ(whole.field(toward(92 * kDegree, 0)), 0.0);  // next to the rim the cubic must not leak
  EXPECT_FALSE(table_of(lopsided, axis(-180, 175, 5), axis(-90, 90, 5)).is_dark_behind());
  EXPECT_FALSE(table_of([](double, double) { return 1.0; }, axis(-95, 90, 5), axis(-20, 20, 5)).is_dark_behind());
}

TEST(GainTable, PhaseIsInterpolatedThroughItsWraps) {
  const auto azimuth = axis(-90, 90, 5), elevation = axis(-90, 90, 5);
  const auto phase = [](double along, double up) { return 6.0 * toward(along, up).y(); };  // wraps at 31.6 degrees
  const Pattern wrapped = [&](double a, double e) { return std::remainder(phase(a, e), kTwoPi); };
  const GainTable table(azimuth, elevation, sampled(cosine4, azimuth, elevation), sampled(wrapped, azimuth, elevation));
  const AntennaPattern pattern = AntennaPattern::of_table(table);
  for (const double angle : {2.5, 31.6, 33.0, -47.5}) {
    const Vec3 u = toward(angle * kDegree, 0.1);
    EXPECT_NEAR(std::remainder(pattern.toward(u).phase - phase(angle * kDegree, 0.1), kTwoPi), 0.0, kTurnedPattern) << angle;
    EXPECT_NEAR(pattern.toward(u).power / cosine4(angle * kDegree, 0.1), 1.0, kTurnedPattern) << angle;
  }
}

TEST(GainTable, BadTablesNameTheArgument) {
  const std::vector<double> two = {0.0, 0.1}, three = {0.0, 0.1, 0.2}, ones(4, 1.0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_error<std::invalid_argument>([&] { GainTable({0.0}, two, {1.0, 1.0}); }, {"azimuth: "});
  expect_error<std::invalid_argument>([&] { GainTable({0.1, 0.0}, two, ones); }, {"azimuth: must ascend"});
  expect_error<std::invalid_argument>([&] { GainTable({0.0, 6.4}, two, ones); }, {"azimuth: must cover"});
  expect_error<std::invalid_argument>([&] { GainTable(two, {0.0, 1.6}, ones); }, {"elevation: must lie"});
  expect_error<std::invalid_argument>([&] { GainTable(two, three, ones); }, {"gain: must have"});
  expect_error<std::invalid_argument>([&] { GainTable(two, two, {1.0, 1.0, -1.0, 1.0}); }, {"gain: must not be neg"});
  expect_error<std::invalid_argument>([&] { GainTable(two, two, {1.0, 1.0, nan, 1.0}); }, {"gain: must be finite"});
  expect_error<std::invalid_argument>([&] { GainTable(two, two, {0.0, 0.0, 0.0, 0.0}); }, {"gain: must not be 0"});
  expect_error<std::invalid_argument>([&] { GainTable(two, two, ones, {0.0, 1.0}); }, {"phase: must have"});
  const Pattern torn = [](double azimuth, double) { return azimuth > 3.0 ? 0.5 : 0.4; };
  const auto turn = axis(-180, 180, 10), height = axis(-90, 90, 10);
  expect_error<std::invalid_argument>([&] { table_of(torn, turn, height); }, {"gain: must agree"});
}

TEST(AntennaPattern, KnowsItsEfficiency) {
  EXPECT_NEAR(AntennaPattern::cosine_power(3.0).efficiency(), 1.0, kRounding);
  EXPECT_NEAR(AntennaPattern::cosine_power(3.0, 4.0).efficiency(), 0.5, kRounding);
  EXPECT_EQ(AntennaPattern::isotropic(0.7).efficiency(), 0.7);
  const AntennaPattern pattern = AntennaPattern::of_table(table_of(cosine4, axis(-90, 90, 5), axis(-90, 90, 5)));
  EXPECT_EQ(pattern.efficiency(), pattern.table->efficiency());
  EXPECT_EQ(pattern.peak_gain, 10.0);
  EXPECT_THROW(pattern.gain(1.0), std::invalid_argument);
}

// A field exp(-s^2 x^2 / 2) has its steepest slope, s / sqrt(e), at x = 1 / s. The narrower of two widths counts, on the
// level as on a cone around the pole, and phases do not.
TEST(AntennaPattern, KnowsItsSharpness) {
  constexpr double kSharp = 40.0, kBlunt = 5.0, kOfSteps = 0.01;  // steps of 0.1 degrees against 1 / 40 rad
  for (const double up : {0.0, 60.0}) {
    const auto azimuth = axis(-20, 20, 0.1), elevation = axis(up - 5, up + 5, 0.1);
    const auto gain_of = [&](double along, double above) {
      const double x = along * std::cos(above), y = above - up * kDegree;
      return std::exp(-(kSharp * kSharp * x * x + kBlunt * kBlunt * y * y));  // of the power
    };
    const auto gain = sampled(gain_of, azimuth, elevation);
    std::vector<double> phase;
    for (size_t i = 0; i < gain.size(); ++i) phase.push_back(0.5 * static_cast<double>(i % 2));
    EXPECT_NEAR(GainTable(azimuth, elevation, gain).sharpness(), kSharp, kOfSteps * kSharp) << up;
    EXPECT_NEAR(GainTable(azimuth, elevation, gain, phase).sharpness(), kSharp, kOfSteps * kSharp) << up;
  }
  EXPECT_EQ(AntennaPattern::isotropic().sharpness(), 0.0);
  EXPECT_EQ(AntennaPattern::cosine_power(0.0).sharpness(), 0.0);
  EXPECT_NEAR(AntennaPattern::cosine_power(2.0 * kSharp * kSharp).sharpness(), kSharp, kRounding * kSharp);
}

// Samples that alternate in sign, at steps of 2 and 40 degrees: the cubic between them goes far beyond.
TEST(GainTable, NothingIsBeyondTheSamplesByMoreThanItSays) {
  const std::vector<double> azimuth = {0.0, 2 * kDegree, 42 * kDegree, 44 * kDegree, 84 * kDegree};
  const std::vector<double> elevation = {-20 * kDegree, 0.0, 5 * kDegree, 30 * kDegree};
  std::vector<double> gain, phase;
  for (size_t row = 0; row < elevation.size(); ++row) {
    for (size_t column = 0; column < azimuth.size(); ++column) {
      gain.push_back(0.01);
      phase.push_back((row + column) % 2 ? kPi : 0.0);
    }
  }
  const GainTable table(azimuth, elevation, gain, phase);
  double most = 0.0;
  for (double a = 0.0; a <= 84.0; a += 0.5) {
    for (double e = -20.0; e <= 30.0; e += 0.5) {
      most = std::max(most, std::abs(table.field({std::cos(e * kDegree) * std::cos(a * kDegree),
                                                  std::cos(e * kDegree) * std::sin(a * kDegree), std::sin(e * kDegree)})));
    }
  }
  EXPECT_GT(most, 2.0 * std::sqrt(table.peak_gain()));
  EXPECT_LE(most, table.largest_field());
}

}  // namespace
}  // namespace echopath::test_gain_table
