// Intervals of powers: against laws that say how fields change with launch cells.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>

#include "echopath/power/interval/power_interval.h"

namespace echopath::test_power_interval {
namespace {

// Two-sided 95 % quantiles as any table of Student's t has them.
TEST(PowerInterval, QuantilesOfStudent) {
  constexpr double kThreeDigits = 1e-3;
  const std::pair<int, double> table[] = {{1, 12.706}, {3, 3.182},  {4, 2.776}, {5, 2.571},
                                          {7, 2.365},  {10, 2.228}, {63, 1.998}};
  for (const auto& [degrees, quantile] : table) EXPECT_NEAR(student_t95(degrees) / quantile, 1.0, kThreeDigits) << degrees;
}

// An echo that is known to a thousandth says nothing of one whose rays are too far apart, for which the filter leaves
// nothing.
TEST(PowerInterval, AKindThatIsKnownDoesNotSpeakForAnother) {
  CoherentKind known, lost;
  for (std::complex<double>& field : known.field) field = 1.0;
  known.field[kHalfDensity] = 0.999;
  known.power[kAsLaunched] = known.power[kUnfiltered] = 1e-3;
  lost.field[kAsLaunched] = 1e-6;
  lost.power[kPoints] = 0.01;
  PowerEvidence evidence;
  evidence.coherent = 1.0;
  evidence.kinds = {known};
  EXPECT_LT(power_interval(evidence).high, 1.02);
  evidence.kinds = {known, lost};
  EXPECT_GT(power_interval(evidence).high, 1.2);  // the field may be a tenth larger at least
}

// An endless mirror over the same way sends back a field of 0.01: no surface sends back more than twice that, whatever waves
// of points and of edges the cells may hold.
TEST(PowerInterval, NoSurfaceSendsBackMoreThanTwoEndlessMirrors) {
  for (const double size : {0.0, 1e-6}) {
    for (const CellViewIndex view : {kPoints, kEdges}) {
      CoherentKind lost;
      lost.has_cells = true;
      lost.field[kAsLaunched] = size;
      lost.power[view] = 1e4;
      lost.edge_squares = view == kEdges ? 1e8 : 0.0;  // one cell
      PowerEvidence evidence;
      evidence.coherent = size * size;
      evidence.kinds = {lost};
      EXPECT_GT(power_interval(evidence).high, 1.0);
      evidence.kinds[0].image_field = 0.01;
      EXPECT_NEAR(std::sqrt(power_interval(evidence).high), 0.02, 1e-4) << size << " " << view;
    }
  }
}

// Two kinds that cancel, each known to a hundredth: the sum is known to a hundredth of either, not of itself.
TEST(PowerInterval, KindsThatCancelAreKnownAsWellAsOneByOne) {
  PowerEvidence evidence;
  for (const double sign : {1.0, -0.95}) {
    CoherentKind kind;
    for (std::complex<double>& field : kind.field) field = sign;
    kind.field[kHalfDensity] = 0.99 * sign;
    kind.power[kPoints] = 1.0;
    evidence.kinds.push_back(kind);
  }
  evidence.coherent = 0.05 * 0.05;
  const double above = std::sqrt(power_interval(evidence).high) - 0.05;
  EXPECT_GT(above, 1.2 * 0.01);
  EXPECT_LT(above, 2.0 * 1.4 * 0.01 + 0.01);
}

// A kind whose field is `truth` - `lost` s^2 in cells of side s.
CoherentKind falls_with_the_square(double truth, double lost) {
  CoherentKind kind;
  kind.has_cells = true;
  for (const CellViewIndex view : {kAsLaunched, kFiner, kHalfDensity}) {
    kind.field[view] = truth - lost * std::pow(kCellViews[view].side, 2);
  }
  return kind;
}

// Coarser and finer cells tell of the same error: it is held, but not counted as two.
TEST(PowerInterval, TwoMeasuresOfOneErrorCountOnce) {
  for (const double lost : {0.01, 0.03, 0.1}) {
    PowerEvidence evidence;
    evidence.kinds = {falls_with_the_square(1.0, lost)};
    evidence.coherent = std::norm(evidence.kinds.front().field[kAsLaunched]);
    const double above = std::sqrt(power_interval(evidence).high) - (1.0 - lost);
    EXPECT_GT(above, lost);
    EXPECT_LT(above, 1.8 * lost);
  }
}

// A field over several bounces that changes with finer cells is not known, even where coarser cells leave it as it is. It
// may lack what cells hold of edges, here a field as large as its own.
TEST(PowerInterval, EdgesOfSeveralBouncesCountWhereFinerCellsChangeTheField) {
  for (const double change : {0.0, 0.2}) {
    CoherentKind kind = falls_with_the_square(1.0, 0.0);
    kind.has_bounced = true;
    kind.field[kFiner] = 1.0 + change;
    kind.power[kEdges] = 1.0;
    kind.edge_squares = 1e-3;
    PowerEvidence evidence;
    evidence.coherent = 1.0;
    evidence.kinds = {kind};
    const double without = [&] {
      PowerEvidence plain = evidence;
      plain.kinds.front().power[kEdges] = 0.0;
      return power_interval(plain).high;
    }();
    const double with = power_interval(evidence).high;
    if (change == 0.0) EXPECT_EQ(with, without);
    else EXPECT_GT(with, 1.1 * without);
  }
}

// Of a coherent power of 1 W, all of this kind.
PowerInterval interval_of(const CoherentKind& kind) {
  PowerEvidence evidence;
  evidence.coherent = 1.0;
  evidence.kinds = {kind};
  return power_interval(evidence);
}

// Of a row of posts one may be known, while cells hold another wave, of any phase, between rays: where that may be larger,
// nothing may be left of both, though the known one hardly changes with the cells.
TEST(PowerInterval, AFieldBelowWhatCellsMayHoldHasNoLowerEnd) {
  for (const auto& [missing, has_lower_end] : {std::pair(0.8, true), std::pair(1.5, false)}) {
    CoherentKind kind;
    for (std::complex<double>& field : kind.field) field = 1.0;
    kind.power[kPoints] = 4.0 * (1.0 + missing);  // rule (3)
    const PowerInterval found = interval_of(kind);
    EXPECT_NEAR(std::sqrt(found.high), 1.0 + missing, 1e-3);
    EXPECT_EQ(found.low > 0.9, has_lower_end) << found.low;
  }
}

// Facets that stray from the surface that they stand for limit what rays know of it, but never so much that the body could
// not be resolved.
TEST(PowerInterval, FacetsLimitWhatIsKnownByLessThanAResolvedEchoMayErr) {
  constexpr double kResolvedDb = 0.3;
  const auto interval_db = [](double phase) {
    CoherentKind kind = falls_with_the_square(1.0, 0.0);
    kind.facet_phase = phase;
    const PowerInterval found = interval_of(kind);
    return 10.0 * std::log10(std::max(found.high, 1.0 / found.low));
  };
  EXPECT_LT(interval_db(0.0), interval_db(0.3));
  EXPECT_LT(interval_db(0.3), interval_db(0.9));
  EXPECT_LT(interval_db(100.0), 0.5 * kResolvedDb);
}

// A field over several bounces that is weaker than what its cells hold of edges may hardly change by chance. Edges that hold
// a quarter of its power do not hide it.
TEST(PowerInterval, AWeakFieldOfSeveralBouncesMayLackItsEdgesHoweverLittleItChanges) {
  constexpr double kOneCell = 1e-3;  // of the edges' power: of each of 1000 cells, 8/sqrt(1000) = .25 count
  CoherentKind kind = falls_with_the_square(1.0, 0.0);
  kind.has_bounced = true;
  const auto above = [&](double edges) {
    kind.power[kEdges] = edges / 0.253;
    kind.edge_squares = kOneCell * kind.power[kEdges] * kind.power[kEdges];
    return std::sqrt(interval_of(kind).high) - 1.0;
  };
  EXPECT_EQ(above(0.25), above(0.0));
  EXPECT_GT(above(4.0), std::sqrt(4.0));
}

// Waves of any phase, each of a tenth of what cells hold of edges, are missing of the field of a smooth surface, and change
// it as often to less as to more. The wave of a straight edge of flat facets, where all cells are in phase, is as strong as
// what cells hold.
TEST(PowerInterval, EdgesOfSmoothSurfacesMayTakeAwayAsMuchAsTheyAddAndLessThanThoseOfFacets) {
  constexpr double kNumCells = 1000.0, kCounted = 0.253;  // of the power of 1000 cells 8/sqrt(1000) counts
  constexpr double kShare = 0.1, kEdgePower = 4.0;        // W
  const auto of_edges = [&](double phase) {
    CoherentKind kind = falls_with_the_square(1.0, 0.0);
    kind.field[kHalfDensity] = std::polar(1.0, 0.5);  // so that the edges count in full
    kind.facet_phase = phase;
    kind.power[kEdges] = kEdgePower / kCounted;
    kind.edge_squares = kind.power[kEdges] * kind.power[kEdges] / kNumCells;
    return interval_of(kind);
  };
  const PowerInterval smooth = of_edges(0.5), facets = of_edges(0.0);
  std::mt19937 draw(1);
  std::normal_distribution<double> part(0.0, std::sqrt(0.5 * kShare * kEdgePower));
  int num_held = 0;
  constexpr int kDrawn = 1000;
  for (int k = 0; k < kDrawn; ++k) {
    const double power = std::norm(1.0 + std::complex<double>(part(draw), part(draw)));
    num_held += smooth.low <= power && power <= smooth.high;
  }
  EXPECT_GT(num_held, 0.93 * kDrawn);
  EXPECT_LT(smooth.low, 0.05);
  EXPECT_LT(smooth.high, 0.6 * facets.high);
  EXPECT_GT(std::sqrt(facets.high), 1.0 + std::sqrt(kEdgePower));
  EXPECT_NEAR(of_edges(1e-12).high, facets.high, 1e-9 * facets.high);  // rounding bends no plane
}

// What more rays mend lies within the whole interval, and is all of it where facets are what they are.
TEST(PowerInterval, WhatRaysMendIsAPartOfTheInterval) {
  for (const double phase : {0.0, 0.5}) {
    CoherentKind kind = falls_with_the_square(1.0, 0.01);
    kind.facet_phase = phase;
    const PowerInterval found = interval_of(kind);
    EXPECT_EQ(found.low < found.low_of_rays, phase > 0.0);
    EXPECT_EQ(found.high > found.high_of_rays, phase > 0.0);
    EXPECT_EQ(found.bias > found.bias_of_rays, phase > 0.0);
    EXPECT_LE(found.low, found.low_of_rays);
    EXPECT_GE(found.high, found.high_of_rays);
  }
}

}  // namespace
}  // namespace echopath::test_power_interval
