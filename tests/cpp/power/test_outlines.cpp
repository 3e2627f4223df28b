// Errors of sums over even directions: against how much counts of even points scatter, and the pieces of meshes.
#include <gtest/gtest.h>

#include <cmath>

#include "cpp/support/scenes.h"
#include "echopath/power/interval/outlines.h"

namespace echopath::test_outlines {
namespace {

using namespace testing;

TEST(Outlines, OfOneHitAreThoseOfChanceAndOfManyGrowWithTheRoot) {
  Outlines one, many, apart;
  one.add(0, 0, 3.0);
  EXPECT_DOUBLE_EQ(one.variance(), 9.0);
  constexpr int kHits = 1000000;
  for (int i = 0; i < kHits; ++i) many.add(0, 0, 2.0);
  EXPECT_NEAR(many.variance(), 0.36 * 4.0 * std::sqrt(kHits), 0.01 * many.variance());
  for (uint32_t i = 0; i < 50; ++i) apart.add(i % 2, i, 2.0);
  EXPECT_DOUBLE_EQ(apart.variance(), 50 * 4.0);
  apart.add(7, 0, 0.0);
  EXPECT_DOUBLE_EQ(apart.variance(), 50 * 4.0);
}

// Even points (the R2 sequence of Roberts, shifted as a whole) that fall into squares, which are apart and fill a quarter of
// the plane: few large ones, and many that have some points each, or less than one.
TEST(Outlines, HoldTheErrorOfTheNumberOfPoints) {
  constexpr int kShifts = 300, kPoints = 4000;
  constexpr double kFirst = 0.7548776662466927, kSecond = 0.5698402909980532;
  for (const int side : {1, 5, 20, 60}) {
    double sum = 0.0, squares = 0.0, estimate = 0.0;
    for (int shift = 0; shift < kShifts; ++shift) {
      Outlines outlines;
      double count = 0.0;
      for (int i = 0; i < kPoints; ++i) {
        const double x = side * std::fmod(i * kFirst + shift * 0.618034, 1.0);
        const double y = side * std::fmod(i * kSecond + shift * 0.414214, 1.0);
        if (x - std::floor(x) >= 0.5 || y - std::floor(y) >= 0.5) continue;
        outlines.add(0, static_cast<uint32_t>(std::floor(x) + side * std::floor(y)), 1.0);
        count += 1.0;
      }
      sum += count / kShifts;
      squares += count * count / kShifts;
      estimate += outlines.variance() / kShifts;
    }
    EXPECT_NEAR(sum, kPoints / 4.0, 2.0) << side;
    EXPECT_GT(estimate, squares - sum * sum) << side;
  }
}

// Two plates of two triangles each in one mesh, one of them with a seam of repeated vertices.
TEST(MeshPieces, HangTogetherByEdges) {
  Scene scene;
  const Vec3 up(0, 0, 1), aside(0, 1, 0), first(5, 0, 0), second(5, 3, 0);
  add_mesh(scene, "plates",
           {first, first + aside, first + aside + up, first + up, second, second + aside, second + aside + up, second,
            second + aside + up, second + up},
           {{4, 5, 6}, {0, 1, 2}, {7, 8, 9}, {0, 2, 3}}, lambert(0.3));
  MeshPieces pieces(scene);
  EXPECT_EQ(pieces.of(0, 0), pieces.of(0, 2));
  EXPECT_EQ(pieces.of(0, 1), pieces.of(0, 3));
  EXPECT_NE(pieces.of(0, 0), pieces.of(0, 1));
}

}  // namespace
}  // namespace echopath::test_outlines
