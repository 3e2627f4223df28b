// The diffracted field of edges in the uniform theory, against Sommerfeld's half plane and Keller's wedge.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "cpp/em/wedges.h"
#include "echopath/base/constants.h"
#include "echopath/em/edges/edge_shadow.h"

namespace echopath::test_edge_shadow {
namespace {

using Complex = std::complex<double>;
using testing::across, testing::wedge_of;
constexpr double kFarPhase = 1e6;    // rad: no transition reaches the angles tested
constexpr double kOfFresnel = 5e-3;  // the transition that is left
constexpr double kRounding = 1e-10;

struct Coefficients {
  Complex electric, magnetic;  // for fields along the edge
};
Coefficients coefficients(const Wedge& wedge, double source, double at, double phase) {
  const Vec3 in = -across(source), out = across(at);
  const Eigen::Matrix3cd m = diffraction_matrix(wedge, in, out, phase);
  const Vec3 z = Vec3::UnitZ();
  // A magnetic field along z belongs to the electric field H x k.
  const Complex magnetic = (z.cross(out).cast<Complex>().transpose() * m * z.cross(in).cast<Complex>()).value();
  return {m(2, 2), magnetic};
}

TEST(EdgeShadow, IsKellersCoefficientOffTheBoundaries) {
  for (const double exterior : {2.0 * kPi, 1.5 * kPi}) {
    const double n = exterior / kPi, scale = std::sin(kPi / n) / n, source = 1.0;
    for (const double at : {0.3, 1.1, 2.9, 4.5}) {
      const double minus = scale / (std::cos(kPi / n) - std::cos((at - source) / n));
      const double plus = scale / (std::cos(kPi / n) - std::cos((at + source) / n));
      const Coefficients found = coefficients(wedge_of(exterior), source, at, kFarPhase);
      EXPECT_NEAR(std::abs(found.electric - 2.0 * (minus - plus)), 0.0, kOfFresnel) << at;
      EXPECT_NEAR(std::abs(found.magnetic - 2.0 * (minus + plus)), 0.0, kOfFresnel) << at;
    }
  }
}

TEST(EdgeShadow, TakesHalfOfTheWaveAtTheBoundaryOfShadow) {
  const double source = 0.8, phase = 60.0;
  for (const double beside : {1e-4, 1e-7, -1e-7, -1e-4}) {
    const Complex field = 0.5 * coefficients(wedge_of(2.0 * kPi), source, source + kPi + beside, phase).electric *
                          std::polar(1.0 / std::sqrt(2.0 * kPi * phase), -0.25 * kPi);
    // Beyond the boundary the wave is missing, before it half of it is too much.
    EXPECT_NEAR(field.real(), beside > 0 ? 0.5 : -0.5, 0.03);
    EXPECT_NEAR(field.imag(), 0.0, 0.03);
  }
}

TEST(EdgeShadow, HasNoStepAtTheBoundaryOfReflection) {
  const auto at = [](double beside) { return coefficients(wedge_of(2.0 * kPi), 0.8, kPi - 0.8 + beside, 60.0).magnetic; };
  EXPECT_NEAR(std::abs(at(1e-5) - at(-1e-5)), 0.0, 1e-2);
  EXPECT_GT(std::abs(at(0.6) - at(-0.6)), 0.5);
}

// Counted from the other face, the same wedge has the same field, also beside the boundary of that face's reflection.
TEST(EdgeShadow, BothFacesServeAlike) {
  const double exterior = 1.5 * kPi, source = exterior - 0.8;
  for (const double at : {0.3, exterior - kPi + 0.7, exterior - kPi + 0.9}) {
    const Coefficients one = coefficients(wedge_of(exterior), source, at, 40.0),
                       other = coefficients(wedge_of(exterior), exterior - source, exterior - at, 40.0);
    EXPECT_LT(std::abs(one.electric - other.electric), kRounding) << at;
    EXPECT_LT(std::abs(one.magnetic - other.magnetic), kRounding) << at;
  }
}

// Of a wave aslant to the edge the part across it counts, as if the distances were shorter by the square of its sine.
TEST(EdgeShadow, ObliqueWavesAreThoseAcrossTheEdgeWithShorterDistances) {
  const Wedge wedge = wedge_of(1.5 * kPi);
  const double source = 0.9, at = 3.7, sine = 0.6, phase = 20.0;
  const Vec3 in = testing::direction(source + kPi, 0.8), out = testing::direction(at, 0.8);
  const Vec3 around_in = testing::across(source + 1.5 * kPi), around_out = testing::across(at + 0.5 * kPi);
  const auto around = [&](const Eigen::Matrix3cd& m) {
    return (around_out.cast<Complex>().transpose() * m * around_in.cast<Complex>()).value();
  };
  const Complex oblique = around(diffraction_matrix(wedge, in, out, phase));
  const Complex across_it = around(diffraction_matrix(wedge, -across(source), across(at), phase * sine * sine));
  EXPECT_LT(std::abs(oblique - across_it), kRounding);
}

// A half plane's field of reflection is its field of shadow of the image of the source, where nothing fades. `detour` is
// that of the way over the edge, in wavelengths.
TEST(EdgeShadow, ReflectionFadesWithinHalfAFresnelZone) {
  const double source = 0.8, phase = 60.0;
  const auto kept = [&](double detour) {
    const double beside = 2.0 * std::asin(std::sqrt(0.5 * kTwoPi * detour / phase));
    const Coefficients found = coefficients(wedge_of(kTwoPi), source, kPi - source - beside, phase),
                       image = coefficients(wedge_of(kTwoPi), source, kPi + source - beside, phase);
    return std::abs(found.magnetic - found.electric) / std::abs(image.magnetic + image.electric);
  };
  EXPECT_GT(kept(0.5), 0.95);
  EXPECT_LT(kept(0.125), 0.6);
  EXPECT_LT(kept(0.001), 0.01);
}

TEST(EdgeShadow, IsReciprocal) {
  const Wedge wedge = wedge_of(1.5 * kPi);
  const auto on_cone = [](double angle) -> Vec3 { return 0.8 * across(angle) + Vec3(0.0, 0.0, 0.6); };
  const Vec3 in = on_cone(0.9 + kPi), out = on_cone(2.1);
  const Eigen::Matrix3cd there = diffraction_matrix(wedge, in, out, 40.0), back = diffraction_matrix(wedge, -out, -in, 40.0);
  const Vec3 beside = in.unitOrthogonal(), beyond = out.cross(Vec3::UnitX()).normalized();
  const auto element = [](const Eigen::Matrix3cd& m, const Vec3& to, const Vec3& from) {
    return (to.cast<Complex>().transpose() * m * from.cast<Complex>()).value();
  };
  for (const Vec3& field : {beside, Vec3(in.cross(beside))})
    EXPECT_NEAR(std::abs(element(there, beyond, field) - element(back, field, beyond)), 0.0, 1e-12);
}

// The other face of the wedge is another direction, in which the wave may well go straight on.
TEST(EdgeShadow, HasAlongAFaceTheFieldBesideIt) {
  const Wedge wedge = wedge_of(1.5 * kPi);
  const double source = 0.5 * kPi - 2e-3;
  const double beside = std::abs(coefficients(wedge, source, 1e-6, 1e3).magnetic);
  for (const double rounding : {-1e-16, 0.0, 1e-16}) {
    EXPECT_NEAR(std::abs(coefficients(wedge, source, rounding, 1e3).magnetic), beside, 1e-4 * beside) << rounding;
    EXPECT_NEAR(std::abs(coefficients(wedge, rounding, source, 1e3).magnetic), beside, 1e-4 * beside) << rounding;
  }
}

TEST(EdgeShadow, VanishesInsideOfTheWedgeAndAlongTheEdge) {
  const Wedge wedge = wedge_of(1.5 * kPi);
  EXPECT_EQ(diffraction_matrix(wedge, -across(1.0), across(1.8 * kPi), 10.0).norm(), 0.0);
  EXPECT_EQ(diffraction_matrix(wedge, -across(1.8 * kPi), across(1.0), 10.0).norm(), 0.0);
  EXPECT_EQ(diffraction_matrix(wedge, Vec3::UnitZ(), across(1.0), 10.0).norm(), 0.0);
}

}  // namespace
}  // namespace echopath::test_edge_shadow
