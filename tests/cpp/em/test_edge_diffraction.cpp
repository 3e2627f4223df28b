// The fringe of edges against Keller's exact solution.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <random>

#include "cpp/em/wedges.h"

namespace echopath::test_edge_diffraction {
namespace {

using namespace testing;
using Complex = std::complex<double>;
constexpr Complex kJ{0.0, 1.0};
constexpr double kRounding = 1e-9;  // near poles that cancel

// Keller's coefficients of a wedge less those of the physical optics of its lit faces, f1 and g1 of Ufimtsev 2007
// (Fundamentals of the Physical Theory of Diffraction, equations 3.59 and 4.20 to 4.22).
struct FringeOfWedge {
  double electric, magnetic;
};
FringeOfWedge ufimtsev(double exterior, double source, double at) {
  const double n = exterior / kPi, scale = std::sin(kPi / n) / n;
  const double minus = scale / (std::cos(kPi / n) - std::cos((at - source) / n));
  const double plus = scale / (std::cos(kPi / n) - std::cos((at + source) / n));
  FringeOfWedge fringe{minus - plus, minus + plus};
  const auto leave_out = [&](double from, double to) {
    fringe.electric -= std::sin(from) / (std::cos(to) + std::cos(from));
    fringe.magnetic += std::sin(to) / (std::cos(to) + std::cos(from));
  };
  if (source < kPi) leave_out(source, at);
  if (exterior - source < kPi) leave_out(exterior - source, exterior - at);
  return fringe;
}

TEST(EdgeDiffraction, FringeOnKellersConeIsThatOfUfimtsev) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < 2000; ++i) {
    const double exterior = kPi * (1.05 + 0.95 * unit(random)), cosine = i % 2 ? 0.0 : 1.8 * unit(random) - 0.9;
    const double source = exterior * unit(random), at = exterior * unit(random);
    const FringeOfWedge expected = ufimtsev(exterior, source, at);
    if (std::abs(expected.electric) + std::abs(expected.magnetic) > 1e3) continue;  // two poles cancel there
    const Vec3 in = -direction(source, -cosine), out = direction(at, cosine);
    const Mat3 fringe = fringe_matrix(wedge_of(exterior), in, out);
    const Vec3 edge = Vec3::UnitZ();
    const Vec3 electric = edge - in * in.dot(edge);  // without a magnetic field along the edge
    EXPECT_NEAR(edge.dot(fringe * electric), 2.0 * expected.electric * edge.dot(electric), 1e-6) << i;
    const Vec3 magnetic = in.cross(edge);  // its magnetic field is in x this
    EXPECT_NEAR(edge.dot(out.cross(fringe * magnetic)), 2.0 * expected.magnetic * edge.dot(in.cross(magnetic)), 1e-6) << i;
  }
}

// Where the waves of geometrical optics end, both poles of the coefficient cancel.
TEST(EdgeDiffraction, IsSmoothAcrossTheBoundariesOfReflectionAndShadow) {
  const double source = 0.5 * kPi, beside = 1e-3;
  for (const double boundary : {kPi - source, kPi + source}) {
    const auto at = [&](double off) { return fringe_matrix(wedge_of(kTwoPi), -across(source), across(boundary + off)); };
    const Mat3 mean = 0.5 * (at(beside) + at(-beside));
    for (const double off : {0.0, 1e-9, -1e-7}) EXPECT_LT((at(off) - mean).norm(), 1e-3 * mean.norm()) << boundary << off;
  }
}

TEST(EdgeDiffraction, FlatWedgeHasNone) {
  const Wedge flat = wedge_of(kPi);
  for (const double source : {0.2, 1.0, 2.5}) {
    for (const double at : {0.1, 1.3, 3.0}) {
      const Mat3 fringe = fringe_matrix(flat, -direction(source, 0.3), direction(at, -0.2));
      EXPECT_LT(fringe.norm(), kRounding);
    }
  }
}

TEST(EdgeDiffraction, InsideOfTheWedgeIsDark) {
  const Wedge box = wedge_of(1.5 * kPi);
  EXPECT_FALSE(is_outside(box, across(1.7 * kPi)));
  EXPECT_TRUE(is_outside(box, across(1.4 * kPi)));
  EXPECT_EQ(fringe_matrix(box, -across(1.0), across(1.7 * kPi)).norm(), 0.0);
  EXPECT_EQ(fringe_matrix(box, -across(1.7 * kPi), across(1.0)).norm(), 0.0);
}

TEST(EdgeDiffraction, WedgeOfFacesHasTheirAngle) {
  for (const double exterior : {1.1 * kPi, 1.5 * kPi, 1.9 * kPi}) {
    const Wedge made = wedge_of(exterior);
    EXPECT_NEAR(wedge_between(made.faces[0], made.faces[1]).exterior_angle, exterior, 1e-12);
    EXPECT_NEAR(wedge_between(made.faces[1], made.faces[0]).exterior_angle, exterior, 1e-12);
  }
  const WedgeFace sheet = wedge_of(kTwoPi).faces[0];
  EXPECT_EQ(wedge_between(sheet, {sheet.inward, -sheet.normal}).exterior_angle, kTwoPi);
}

// Which face is called the first does not matter.
TEST(EdgeDiffraction, FacesMayBeExchanged) {
  const Wedge one = wedge_of(1.6 * kPi), other{{one.faces[1], one.faces[0]}, one.exterior_angle};
  const Vec3 in = -direction(0.7, 0.2), out = direction(2.9, -0.4);
  EXPECT_LT((fringe_matrix(one, in, out) - fringe_matrix(other, in, out)).norm(), 1e-12);
}

// The field of an edge on Keller's cone, with that of physical optics, is the same when source and receiver change their
// places.
TEST(EdgeDiffraction, WithPhysicalOpticsItIsReciprocalOnTheCone) {
  const double exterior = 1.7 * kPi;
  const Vec3 edge = Vec3::UnitZ();
  const auto total = [&](double source, double at, double cosine) {
    const Vec3 in = -direction(source, -cosine), out = direction(at, cosine);
    double optics = 0.0;  // of the electric field along the edge
    if (source < kPi) optics += 2.0 * std::sin(source) / (std::cos(at) + std::cos(source));
    if (exterior - source < kPi)
      optics += 2.0 * std::sin(exterior - source) / (std::cos(exterior - at) + std::cos(exterior - source));
    const Vec3 electric = edge - in * in.dot(edge);
    return optics + edge.dot(fringe_matrix(wedge_of(exterior), in, out) * electric) / edge.dot(electric);
  };
  for (const double cosine : {0.0, 0.4}) EXPECT_NEAR(total(0.5, 3.9, cosine), total(3.9, 0.5, -cosine), 1e-9);
}

// A sheet seen along itself: the limit of directions nearby, for the field across it as for that along its edge.
TEST(EdgeDiffraction, ItsOwnPlaneIsNoException) {
  const Wedge sheet = wedge_of(kTwoPi);
  const Mat3 in_plane = fringe_matrix(sheet, -across(0.0), across(0.0)),
             beside = fringe_matrix(sheet, -across(2e-3), across(2e-3));
  EXPECT_LT((in_plane - beside).norm(), 0.01 * beside.norm());
  EXPECT_GT(std::abs(in_plane(1, 1)), 1.0);
}

// By the integral of e^{-j(xs + bs^2)} over a piece around its middle.
TEST(EdgeDiffraction, FilterIsTheMeanOfThePhases) {
  for (const double phase : {0.0, 1e-5, 0.3, 0.399, 0.401, 2.0, -3.0, 9.0}) {
    for (const double bend : {0.0, 0.05, 0.8}) {
      Complex sum = 0.0;
      for (int i = 0; i < 10000; ++i) {
        const double s = 2.0 * (i + 0.5) / 10000.0 - 1.0;
        sum += std::exp(-kJ * (0.5 * phase * s + bend * s * s)) / 10000.0;
      }
      EXPECT_LT(std::abs(edge_filter(phase, bend) - sum), 1e-7 + bend * bend * bend / 40.0) << phase << " " << bend;
    }
  }
}

// On the cone, what a wedge makes of a wave along its face is Keller's coefficient.
TEST(EdgeDiffraction, GrazingWaveHasKellersCoefficientOnTheCone) {
  for (const double exterior : {1.2 * kPi, 1.5 * kPi, kTwoPi}) {
    for (const double cosine : {0.0, 0.4, -0.6}) {
      for (double at = 0.2; at < exterior; at += 0.37) {
        if (std::abs(at - kPi) < 0.05) continue;  // the wave's own direction
        const Wedge wedge = wedge_of(exterior);
        const Vec3 along = -direction(0.0, -cosine), out = direction(at, cosine), edge = Vec3::UnitZ();
        const Vec3 field = field_of_grazing_wave(wedge, 0, along, out);
        const double magnetic = edge.dot(along.cross(wedge.faces[0].normal));
        EXPECT_NEAR(edge.dot(out.cross(field)), 2.0 * grazing_coefficient(exterior, 0.0, at) * magnetic,
                    1e-4 / std::abs(at - kPi))
            << exterior << " " << cosine << " " << at;
      }
    }
  }
}

}  // namespace
}  // namespace echopath::test_edge_diffraction
