// Edges as the record knows them against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "cpp/em/wedges.h"
#include "echopath/record/paths.h"
#include "echopath/record/posed_edge.h"

namespace echopath::test_posed_edge {
namespace {

using testing::across;

TEST(PosedEdge, ItsOutsideIsInTheMiddleBetweenItsFaces) {
  for (const double exterior : {1.2 * kPi, 1.5 * kPi, 1.9 * kPi})
    EXPECT_LT((outward_of(testing::wedge_of(exterior)) - across(0.5 * exterior)).norm(), 1e-12) << exterior;
}

TEST(PosedEdge, KeepsWhatTheFaceThatLooksAtTheAntennaReflects) {
  Material rough;
  rough.permittivity = 4.0;
  rough.roughness_height = 0.2e-3;
  const double phase = kTwoPi * 77e9 / kSpeedOfLight * 0.2e-3;
  const Wedge box = testing::wedge_of(1.5 * kPi);
  for (const double face : {0.5 * kPi, kPi})
    EXPECT_NEAR(kept_share(rough, 77e9, box, across(face)), std::exp(-2.0 * phase * phase) / 3.0, 1e-12) << face;
}

// By Pythagoras, for antennas abreast of the edge.
TEST(PosedEdge, TheLongestPieceHasThePhaseAskedForAtItsEnds) {
  const PosedEdge edge{0, {}, testing::wedge_of(1.5 * kPi), Vec3(0.0, 0.0, -1.0), Vec3(0.0, 0.0, 1.0)};
  const double wavenumber = 1600.0, phase = 0.8;
  const double half = 0.5 * longest_piece(edge, Vec3(3.0, 0.0, 0.0), Vec3(0.0, 5.0, 0.0), wavenumber, phase);
  EXPECT_NEAR(wavenumber * (std::hypot(3.0, half) - 3.0 + std::hypot(5.0, half) - 5.0), phase, 0.001);
}

TEST(BesideEdge, FlagsHoldTheShareOfTheField) {
  for (const double size : {1e-5, 0.3, 1.0, 1.4}) {
    for (const double angle : {-3.0, -1.0, 0.0, 0.5, 3.0}) {
      const std::complex<double> share = std::polar(size, angle);
      EXPECT_LT(std::abs(share_of_endless(beside_edge_flags(share)) - share), 1.0 / 512.0) << share;
      EXPECT_NE(share_of_endless(beside_edge_flags(share)), 0.0);
    }
  }
  EXPECT_EQ(share_of_endless(0), 1.0);
}

}  // namespace
}  // namespace echopath::test_posed_edge
