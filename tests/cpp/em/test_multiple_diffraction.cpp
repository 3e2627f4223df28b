// Waves that run from edge to edge over flat faces.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "cpp/em/wedges.h"
#include "echopath/base/constants.h"
#include "echopath/em/edges/multiple_diffraction.h"

namespace echopath::test_multiple_diffraction {
namespace {

using Complex = std::complex<double>;
using testing::across;
constexpr Complex kJ{0.0, 1.0};
constexpr double kWavenumber = 200.0;  // rad/m

// A strip in the plane y = 0 between x = 0 and x = width, whose edges lie along z.
std::array<DiffractingEdge, 2> strip(double width) {
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY();
  return {DiffractingEdge{{{{x, y}, {x, -y}}, kTwoPi}, Vec3::Zero()},
          DiffractingEdge{{{{-x, y}, {-x, -y}}, kTwoPi}, width * x}};
}

// Returns the strength of the wave that a field makes which arrives from a distance (m).
Complex entered(const MultipleDiffraction& multiple, const Vec3& in, const FieldVector& field, double distance) {
  return multiple.enter(in, distance).transpose() * field;
}

// Returns the magnetic field that multiple diffraction sends toward an angle from a wave of a unit magnetic field that comes
// from another angle, in units of c^2, c = e^{-j pi/4} / (2 sqrt(2 pi k)), over e^{-jka}/sqrt(a).
Complex sent(std::span<const DiffractingEdge> edges, double source, double at, double width) {
  const MultipleDiffraction multiple = *MultipleDiffraction::over(edges, kWavenumber);
  const Vec3 in = -across(source), out = across(at), edge = Vec3::UnitZ(), electric = edge.cross(-in);
  const FieldVector left = multiple.leave(out, 1e9) * entered(multiple, in, electric.cast<Complex>(), 1e9);
  const Complex magnetic = out.cast<Complex>().cross(left).dot(edge.cast<Complex>()) * edge.dot(in.cross(electric));
  return std::conj(magnetic) / 0.25 * std::sqrt(kTwoPi * kWavenumber * width) * std::polar(1.0, 0.25 * kPi) / 2.0;
}

// By its integral along the line from sqrt(x) on, turned into one of e^{-s}.
TEST(MultipleDiffraction, TransitionIsTheIntegralOfKouyoumjianAndPathak) {
  for (const double x : {0.0, 1e-3, 0.1, 1.0, 1.99, 2.01, 3.0, 10.0, 20.1, 100.0}) {
    Complex sum = 0.0;  // int_0^inf e^{-s} / (2 sqrt(x - js)) ds, after t^2 = x - js
    const int count = 400000;
    for (int i = 0; i < count; ++i) {
      const double r = (i + 0.5) * 6.0 / count, s = r * r;
      sum += std::exp(-s) * 2.0 * r / (2.0 * std::sqrt(Complex(x, -s))) * 6.0 / static_cast<double>(count);
    }
    const Complex expected = 2.0 * kJ * std::sqrt(x) * sum * Complex(0.0, -1.0);
    EXPECT_LT(std::abs(transition(x) - expected), 1e-4) << x;
  }
}

// Ross 1966: 4 / (cos(source/2) cos(at'/2)), at' from the second edge, where no transition is near.
TEST(MultipleDiffraction, AStripHasKellersDoubleDiffraction) {
  constexpr double kWidth = 20.0;
  const auto edges = strip(kWidth);
  for (const double source : {0.6, 1.2, 1.9}) {
    for (const double at : {1.3, 2.0, 2.5}) {
      const double expected = 4.0 / (std::cos(0.5 * source) * std::cos(0.5 * (kPi - at)));
      EXPECT_NEAR(std::abs(sent(edges, source, at, kWidth)), expected, 0.01 * expected) << source << " " << at;
    }
  }
}

// Keller 1962, for a magnetic field along the edge of a wedge, over e^{-j pi/4}/sqrt(2 pi k).
double keller(double exterior, double source, double at) {
  const double n = exterior / kPi, boundary = std::cos(kPi / n);
  return std::sin(kPi / n) / n *
         (1.0 / (boundary - std::cos((at - source) / n)) + 1.0 / (boundary - std::cos((at + source) / n)));
}

// A wave that has run to the far edge and back leaves the near one as another wave along the strip, weaker by the spread of
// one more cylindrical wave.
TEST(MultipleDiffraction, AWaveThatRunsToAndFroSpreadsOnceMore) {
  constexpr double kWidth = 20.0;
  const auto edges = strip(kWidth);
  const std::array<DiffractingEdge, 3> to_and_fro = {edges[0], edges[1], edges[0]};
  const double source = 1.2, at = 2.0;
  const double expected = 4.0 / (std::cos(0.5 * source) * std::cos(0.5 * at)) / std::sqrt(kTwoPi * kWavenumber * kWidth);
  EXPECT_NEAR(std::abs(sent(to_and_fro, source, at, kWidth)), expected, 0.01 * expected);
}

// Around two corners of a box: each edge makes a cylindrical wave, and on a face a wave is half of one from afar.
TEST(MultipleDiffraction, ABoxHasKellersWaveAroundItsCorners) {
  const double top = 20.0, side = 30.0, corner = 1.5 * kPi, source = 1.0;
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY();
  const std::array<DiffractingEdge, 3> edges = {DiffractingEdge{{{{x, y}, {-y, -x}}, corner}, Vec3::Zero()},
                                                DiffractingEdge{{{{-x, y}, {-y, x}}, corner}, top * x},
                                                DiffractingEdge{{{{y, x}, {-x, -y}}, corner}, top * x - side * y}};
  const MultipleDiffraction multiple = *MultipleDiffraction::over(edges, kWavenumber);
  const Vec3 in = -across(source);
  const FieldVector electric = Vec3::UnitZ().cross(-in).cast<Complex>();
  const auto spread = [](double length) { return std::polar(1.0 / std::sqrt(kTwoPi * kWavenumber * length), -0.25 * kPi); };
  const Complex expected = keller(corner, source, 0.0) * spread(top) * 0.5 * keller(corner, 0.0, corner) * spread(side);
  const Complex found = entered(multiple, in, electric, 1e9);
  EXPECT_LT(std::min(std::abs(found - expected), std::abs(found + expected)), 0.01 * std::abs(expected));
  EXPECT_DOUBLE_EQ(multiple.length(), top + side);
  // From an antenna as far before the first edge as all of the way behind it, the wave of a sphere has spread twice as far.
  EXPECT_NEAR(std::abs(entered(multiple, in, electric, top + side)), std::sqrt(0.5) * std::abs(expected),
              0.01 * std::abs(expected));
  const Vec3 out = across(-0.3);
  const FieldVector left = field_of_grazing_wave(edges[2].wedge, 0, -y, out).cast<Complex>();
  EXPECT_LT((multiple.leave(out, 1e9) - 0.5 * left).norm(), 0.01 * left.norm());
}

// The sides of a sheet are two faces only where it ends at both edges.
TEST(MultipleDiffraction, ASheetThatABoxEndsCarriesHalfAWave) {
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), out = across(0.3);
  auto edges = strip(20.0);
  edges[1].wedge = {{{-x, y}, {-y, x}}, 1.5 * kPi};
  const FieldVector left = field_of_grazing_wave(edges[1].wedge, 0, x, out).cast<Complex>();
  EXPECT_LT((MultipleDiffraction::over(edges, kWavenumber)->leave(out, 1e9) - 0.5 * left).norm(), 0.01 * left.norm());
}

TEST(MultipleDiffraction, OneEdgeTurnsThePhaseByAnEighth) {
  const auto edges = strip(20.0);
  const Vec3 in = -across(1.2);
  const FieldVector electric = Vec3::UnitZ().cross(-in).cast<Complex>();
  const Complex found = entered(*MultipleDiffraction::over(edges, kWavenumber), in, electric, 1e9);
  EXPECT_NEAR(std::arg(found * found), -0.5 * kPi, 0.01);
}

// Both ways over a gentle ridge, whose far face lies nearly in the direction of the wave on the near one.
TEST(MultipleDiffraction, IsReciprocalOverARidge) {
  const double slope = 0.05, near = 0.2, far = 0.7;
  const Vec3 left = across(kPi + slope), right = across(-slope), over_left = across(0.5 * kPi + slope),
             over_right = across(0.5 * kPi - slope);
  const std::array<DiffractingEdge, 3> edges = {
      DiffractingEdge{{{{-left, over_left}, {-left, -over_left}}, kTwoPi}, near * left},
      DiffractingEdge{{{{right, over_right}, {left, over_left}}, kPi + 2.0 * slope}, Vec3::Zero()},
      DiffractingEdge{{{{-right, over_right}, {-right, -over_right}}, kTwoPi}, far * right}};
  const std::array<DiffractingEdge, 3> back = {edges[2], edges[1], edges[0]};
  const Complex there = sent(edges, 2.0, 0.9, near);
  EXPECT_LT(std::abs(there - sent(back, 0.9, 2.0, near)), 1e-6 * std::abs(there));
}

TEST(MultipleDiffraction, DoesNotDependOnTheOrderOfAnEdgesFaces) {
  const auto edges = strip(0.3);
  auto turned = edges;
  std::swap(turned[0].wedge.faces[0], turned[0].wedge.faces[1]);
  EXPECT_LT(std::abs(sent(edges, 1.2, 2.0, 0.3) - sent(turned, 1.2, 2.0, 0.3)), 1e-12);
}

// Between two edges in one plane the waves run side by side.
TEST(MultipleDiffraction, PiecesReachAsWideOnASlantedEdge) {
  auto edges = strip(0.3);
  const double slant = 0.4;
  const Vec3 inward(-std::cos(slant), 0.0, std::sin(slant)), y = Vec3::UnitY();
  edges[1].wedge.faces[0] = {inward, y};
  edges[1].wedge.faces[1] = {inward, -y};
  const Vec3 piece = MultipleDiffraction::over(edges, kWavenumber)->last_piece(0.01 * Vec3::UnitZ());
  EXPECT_LT((piece - 0.01 * Vec3(std::tan(slant), 0.0, 1.0)).norm(), 1e-12);
}

// The way back of a wave from another direction is the same.
TEST(MultipleDiffraction, IsReciprocal) {
  const auto edges = strip(0.3);
  const std::array<DiffractingEdge, 2> back = {edges[1], edges[0]};
  const std::array<DiffractingEdge, 3> there_and_back = {edges[0], edges[1], edges[0]};
  for (const double source : {0.4, 1.5, 2.9}) {
    for (const double at : {0.3, 1.2, 2.2, 3.0}) {
      EXPECT_LT(std::abs(sent(edges, source, at, 0.3) - sent(back, at, source, 0.3)), 1e-6) << source << " " << at;
      EXPECT_LT(std::abs(sent(there_and_back, source, at, 0.3) - sent(there_and_back, at, source, 0.3)), 1e-6)
          << source << " " << at;
    }
  }
}

// An antenna beside another one sees the edge from off the cone about the way that the points were found for. Its field is
// nearly that over the points of its own cone, which lie 2.5 mm aside; it had grown as one over the height above the face.
TEST(MultipleDiffraction, AntennasBesideTheConeHaveNearlyTheSameFieldAtEveryHeightOverTheFace) {
  const auto edges = strip(0.5);
  std::array<DiffractingEdge, 2> own = edges;
  own[0].point.z() = 0.0025;
  for (const double height : {0.0, 1e-5, 1e-3, 1e-2, 0.3}) {
    const Vec3 antenna(-3.0, height, 0.0175);
    const auto strength = [&](const std::array<DiffractingEdge, 2>& points) {
      const Vec3 way = points[0].point - antenna, in = way.normalized();
      const FieldVector electric = Vec3::UnitZ().cross(-in).normalized().cast<Complex>();
      return std::abs(entered(*MultipleDiffraction::over(points, kWavenumber), in, electric, way.norm()));
    };
    EXPECT_NEAR(strength(edges), strength(own), 0.01 * strength(own)) << height;
  }
}

// Along a sheet with its electric field across it a wave passes as if nothing were there. Physical optics doubles it on the
// lit side, in the limit; what the near edge sends over the face is the wave itself, and takes that away.
TEST(MultipleDiffraction, SeenAlongItselfAnEdgeSendsAsMuchAsTheWave) {
  const auto edges = strip(0.5);
  const MultipleDiffraction multiple = *MultipleDiffraction::over(edges, kWavenumber);
  const Vec3 in = -across(kPi - 1e-6), electric = Vec3::UnitZ().cross(-in);
  EXPECT_NEAR(std::abs(entered(multiple, in, electric.cast<Complex>(), 1e9)), 1.0, 0.01);
  const Vec3 beside = -across(kPi - 1e-3);
  EXPECT_LT(std::abs(entered(multiple, in, electric.cast<Complex>(), 1e9) -
                     entered(multiple, beside, Vec3::UnitZ().cross(-beside).cast<Complex>(), 1e9)),
            0.05);
}

// Against the shortest way over the edge by search.
TEST(MultipleDiffraction, DetourIsThatOfTheShortestWay) {
  const auto edges = strip(0.5);
  const MultipleDiffraction multiple = *MultipleDiffraction::over(edges, kWavenumber);
  const Vec3 antenna(-3.0, 2.0, 0.05);
  double shortest = 1e9;
  for (double z = -0.1; z < 0.1; z += 1e-5) {
    const Vec3 point(0.0, 0.0, z);
    shortest = std::min(shortest, (antenna - point).norm() + (edges[1].point - point).norm());
  }
  const double direct = antenna.norm() + multiple.length();
  EXPECT_NEAR(multiple.detour(-antenna.normalized(), antenna.norm()), shortest - direct, 0.01 * (direct - shortest));
}

TEST(MultipleDiffraction, DetourOfALongerSequenceIsThatOfItsWholeWay) {
  const auto edges = strip(0.5);
  const std::array<DiffractingEdge, 3> to_and_fro = {edges[0], edges[1], edges[0]};
  const auto long_edges = strip(1.0);
  const Vec3 antenna(-3.0, 2.0, 0.05), in = -antenna.normalized();
  EXPECT_DOUBLE_EQ(MultipleDiffraction::over(to_and_fro, kWavenumber)->detour(in, antenna.norm()),
                   MultipleDiffraction::over(long_edges, kWavenumber)->detour(in, antenna.norm()));
}

TEST(MultipleDiffraction, NeedsAFaceBetweenTheEdges) {
  auto edges = strip(0.5);
  edges[1].point += 0.1 * Vec3::UnitY();
  EXPECT_FALSE(MultipleDiffraction::over(edges, kWavenumber).has_value());
  edges = strip(0.5);
  std::swap(edges[0].wedge, edges[1].wedge);
  EXPECT_FALSE(MultipleDiffraction::over(edges, kWavenumber).has_value());
  for (const size_t beyond : {0, 1}) {  // the face of one edge reaches to the other one, whose own goes on from there
    edges = strip(0.5);
    edges[beyond].wedge = edges[1 - beyond].wedge;
    EXPECT_FALSE(MultipleDiffraction::over(edges, kWavenumber).has_value());
  }
  edges = strip(0.5);
  std::swap(edges[0].point, edges[1].point);
  EXPECT_FALSE(MultipleDiffraction::over(edges, kWavenumber).has_value());
}

}  // namespace
}  // namespace echopath::test_multiple_diffraction
