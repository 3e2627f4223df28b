// Launch cells that are dark to a whole array are found from its first antennas. Truth is the filter itself, for antennas
// drawn at random around these.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "echopath/base/geometry.h"
#include "echopath/replay/kernels/filter_bound.h"

namespace echopath::test_filter_bound {
namespace {

constexpr double kWavenumber = 1600.0;  // rad/m, at 77 GHz
constexpr int kCells = 400, kAntennas = 60;
constexpr double kRounding = 1e-6;  // of logarithms of filters that cancel digits

struct Draw {
  std::mt19937_64 engine{7};
  double between(double low, double high) { return std::uniform_real_distribution(low, high)(engine); }
  double log_between(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }
  Vec3 direction() {
    std::normal_distribution<double> normal;
    return Vec3(normal(engine), normal(engine), normal(engine)).normalized();
  }
};

// A cell at the origin on a surface with normal +z, and where the antennas of both ends stand.
struct Case {
  CellShape shape;
  Vec3 tangent[2], start, end;
  double around_start, around_end;
};

Case draw_case(Draw& draw, Flatness flatness, bool is_curved) {
  Case of;
  const double size = draw.log_between(1e-3, 0.3), bend = flatness == Flatness::kFlat ? 0.0 : draw.log_between(1e-3, 10.0);
  const double turn = draw.between(0, M_PI);
  of.tangent[0] = size * Vec3(std::cos(turn), std::sin(turn), 0);
  of.tangent[1] = size * draw.log_between(0.2, 1.0) * Vec3(-std::sin(turn), std::cos(turn), 0);
  CellShape& shape = of.shape;
  shape.is_known = true;
  shape.is_curved = is_curved;
  shape.flatness = flatness;
  const double across = draw.between(0, M_PI);
  shape.across[0] = std::cos(across);
  shape.across[1] = std::sin(across);
  for (int i = 0; i < 3; ++i) {
    const int a = i == 2 ? 1 : 0, b = i == 0 ? 0 : 1;
    shape.product[i] = of.tangent[a].dot(of.tangent[b]);
    shape.second_form[i] = bend * (of.tangent[a].x() * of.tangent[b].x() + 0.3 * of.tangent[a].y() * of.tangent[b].y());
    shape.turn[i] = is_curved ? draw.between(-1, 1) * size * size : 0.0;
  }
  // Near the direction of the mirrored wave, or anywhere.
  const Vec3 toward = draw.direction(), other = draw.direction();
  of.start = draw.log_between(1.0, 100.0) * Vec3(toward.x(), toward.y(), std::abs(toward.z()) + 0.05).normalized();
  const Vec3 mirrored(-of.start.x(), -of.start.y(), of.start.z());
  const Vec3 end = mirrored.normalized() + draw.log_between(1e-3, 1.0) * Vec3(other.x(), other.y(), 0);
  of.end = draw.log_between(1.0, 100.0) * end.normalized();
  of.around_start = draw.log_between(1e-3, 0.3) * of.start.norm();
  of.around_end = draw.log_between(1e-3, 0.3) * of.end.norm();
  return of;
}

CellWaves<double> waves_between(const Case& of, const Vec3& start, const Vec3& end) {
  const Vec3 arrival = -start.normalized(), departure = end.normalized();
  CellWaves<double> waves{-arrival.z(), departure.z(), 1.0, 1.0 / start.norm(), 1.0 / end.norm(), {}, {}};
  for (int a = 0; a < 2; ++a) {
    waves.along_arrival[a] = of.tangent[a].dot(arrival);
    waves.along_departure[a] = of.tangent[a].dot(departure);
  }
  return waves;
}

double bound_of(const Case& of, const CellFilter& filter) {
  const TurnedWaves<double> turned{of.around_start / (of.start.norm() - of.around_start),
                                   of.around_end / (of.end.norm() - of.around_end)};
  return largest_cell_filter<ScalarMath>(of.shape, waves_between(of, of.start, of.end), turned, filter);
}

// Expects that no antennas around those of a case get more than the bound, and returns whether this says anything.
bool holds_bound(Draw& draw, const Case& of, const CellFilter& filter) {
  const double bound = bound_of(of, filter);
  for (int i = 0; i < kAntennas; ++i) {
    const Vec3 start = of.start + draw.between(0, 1) * of.around_start * draw.direction();
    const Vec3 end = of.end + draw.between(0, 1) * of.around_end * draw.direction();
    if (start.z() <= 0 || end.z() <= 0) continue;  // they do not see the surface
    const ComplexOf<double> found = cell_filter_of<ScalarMath>(of.shape, waves_between(of, start, end), filter);
    const double size = std::hypot(found.re, found.im);
    if (size > 0.0) {
      EXPECT_LE(std::log(size), bound + kRounding * (1.0 + std::abs(bound)));
    }
  }
  return bound < -1.0;
}

void expect_bounds(Flatness flatness, bool is_curved, Footprint order, int least) {
  Draw draw;
  int num_dark = 0;
  for (int i = 0; i < kCells; ++i) {
    const Case of = draw_case(draw, flatness, is_curved);
    num_dark += holds_bound(draw, of, {kWavenumber, 0.65, order, {}}) ? 1 : 0;
  }
  EXPECT_GT(num_dark, least);
}

TEST(FilterBound, NoAntennaAroundGetsMoreOfACurvedSurface) {
  expect_bounds(Flatness::kCurved, false, Footprint::kSecondOrder, kCells / 20);
}
TEST(FilterBound, NoAntennaAroundGetsMoreOfAFlatSurface) {
  expect_bounds(Flatness::kFlat, false, Footprint::kSecondOrder, kCells / 20);
}
TEST(FilterBound, NoAntennaAroundGetsMoreOfACylinder) {
  expect_bounds(Flatness::kFlatOneWay, false, Footprint::kSecondOrder, kCells / 20);
}
TEST(FilterBound, NoAntennaAroundGetsMoreBehindACurvedBounce) {
  for (const Flatness flatness : {Flatness::kFlat, Flatness::kFlatOneWay, Flatness::kCurved})
    expect_bounds(flatness, true, Footprint::kSecondOrder, kCells / 20);
}
TEST(FilterBound, NoAntennaAroundGetsMoreOfTheFirstOrder) {
  expect_bounds(Flatness::kCurved, false, Footprint::kFirstOrder, kCells / 20);
}

// Far from the mirrored wave, where nothing else is dark, the bound at a single antenna is the filter itself.
TEST(FilterBound, OneAntennaHasTheFilterOfACurvedSurface) {
  Draw draw;
  for (int i = 0; i < kCells; ++i) {
    Case of = draw_case(draw, Flatness::kCurved, false);
    of.around_start = of.around_end = 0.0;
    const CellFilter filter{kWavenumber, 0.65, Footprint::kSecondOrder, {}};
    const CellWaves<double> waves = waves_between(of, of.start, of.end);
    const FootprintPhaseOf<double> phase = cell_phase(of.shape, waves, filter);
    const double fading = std::log(turning_footprint_of<ScalarMath>(phase, filter.spread).size);
    const double a11 = phase.h11, a12 = phase.h12, a22 = phase.h22, variance = 0.65 * 0.65;
    const double size = std::hypot(1.0 - variance * variance * (a11 * a22 - a12 * a12), variance * (a11 + a22));
    if (std::isfinite(fading)) {
      EXPECT_NEAR(bound_of(of, filter), fading + std::log(size), 1e-6 * (1.0 + std::abs(fading)));
    }
  }
}

TEST(FilterBound, NothingIsSaidWithoutAFilter) {
  Draw draw;
  Case of = draw_case(draw, Flatness::kCurved, false);
  EXPECT_EQ(bound_of(of, {kWavenumber, 0.65, Footprint::kNone, {}}), 0.0);
  of.shape.is_known = false;
  EXPECT_EQ(bound_of(of, {kWavenumber, 0.65, Footprint::kSecondOrder, {}}), 0.0);
}

}  // namespace
}  // namespace echopath::test_filter_bound
