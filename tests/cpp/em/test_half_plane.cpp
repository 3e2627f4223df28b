// The fringe of a half plane against Sommerfeld's exact solution, by slow sums.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "cpp/em/wedges.h"

namespace echopath::test_half_plane {
namespace {

using namespace testing;
using Complex = std::complex<double>;
constexpr Complex kJ{0.0, 1.0};

// Returns e^{j pi/4}/sqrt(pi) times the integral of e^{-jt^2} from a to infinity, by a sum along a path on which it decays.
Complex fresnel(double a) {
  if (a < 0) return 1.0 - fresnel(-a);
  const Complex turn = std::polar(1.0, -0.25 * kPi);
  Complex sum = 0.0;
  constexpr double kStep = 0.02;
  for (int i = 0; i < 300; ++i) {
    const double s = kStep * i;
    sum += (i == 0 ? 0.5 : 1.0) * std::exp(-s * s - 2.0 * kJ * a * s * turn);
  }
  return std::exp(-kJ * a * a) * sum * kStep / std::sqrt(kPi);
}

// Holds the currents of Sommerfeld's half plane less those of physical optics at x (in 1/k across the edge): across the edge
// of a unit magnetic field along it, and along the edge of a unit electric field.
struct FringeCurrents {
  Complex across, along;
};
FringeCurrents fringe_currents(double x, double source) {
  const double lit = source < kPi ? 2.0 : 0.0;
  const Complex wave = std::exp(kJ * x * std::cos(source)), share = fresnel(-std::sqrt(2.0 * x) * std::cos(0.5 * source));
  const Complex at_edge =
      std::polar(1.0, 0.25 * kPi) / std::sqrt(kPi) * std::sin(0.5 * source) * std::sqrt(2.0 / x) * std::exp(-kJ * x) / kJ;
  return {(2.0 * share - lit) * wave, (2.0 * share - lit) * std::sin(source) * wave + at_edge};
}

// Returns the first of both at the edge: the exact solution has 1 there on either side.
double at_edge_of(double source) { return source < kPi ? -1.0 : 1.0; }

// Returns the radiation of the fringe currents of one face, in units of j/k as fringe_matrix, by a sum along the strip that
// follows the grazing ray; the currents decay by e^{-loss x}.
Vec3 slow_fringe_of_face(double source, double cosine, const WedgeFace& face, const Vec3& out, const Vec3& field,
                         const Vec3& in, double loss) {
  const Vec3 edge = face.inward.cross(face.normal);
  const double sine = std::sqrt(1.0 - cosine * cosine);
  const double mu = (out.dot(sine * face.inward + cosine * edge) - cosine * cosine) / (sine * sine);
  Complex across = 0.0, along = 0.0;
  const double step = 0.03, end = std::sqrt(20.0 / loss);
  for (double t = 0.5 * step; t < end; t += step) {
    const double x = t * t;
    const FringeCurrents at = fringe_currents(x, source);
    const Complex phase = std::exp(x * (kJ * mu - loss)) * 2.0 * t * step;
    across += at.across * phase;
    along += at.along * phase;
  }
  const Complex slope = -at_edge_of(source) - (kJ * mu - loss) * across;  // of the current across, by parts
  const double magnetic = edge.cross(in).dot(field);
  const Complex of_edge = along / (sine * sine) * edge.dot(field) + kJ * cosine / (sine * sine) * slope * magnetic;
  return ((across / sine * magnetic / kJ).real() * face.inward + (of_edge / kJ).real() * edge).eval();
}

Vec3 slow_fringe(double source, double cosine, const Vec3& out, const Vec3& field, const Vec3& in) {
  const Wedge sheet = wedge_of(kTwoPi);
  const auto with_loss = [&](double loss) -> Vec3 {
    return slow_fringe_of_face(source, cosine, sheet.faces[0], out, field, in, loss) +
           slow_fringe_of_face(kTwoPi - source, -cosine, sheet.faces[1], out, field, in, loss);
  };
  const double loss = 0.02;
  const Vec3 found = (8.0 * with_loss(loss) - 6.0 * with_loss(2.0 * loss) + with_loss(4.0 * loss)) / 3.0;
  return found - out * out.dot(found);
}

TEST(HalfPlane, FringeOffTheConeIsTheSumOfSommerfeldsCurrents) {
  struct Case {
    double source, cosine, at, cosine_out;
  };
  for (const Case& one : {Case{1.0, 0.0, 2.0, 0.0}, Case{1.0, 0.3, 2.0, 0.3}, Case{0.8, 0.5, 1.5, -0.5},
                          Case{4.0, -0.4, 2.2, 0.6}, Case{2.0, 0.7, 5.0, -0.8}}) {
    const Vec3 in = -direction(one.source, -one.cosine), out = direction(one.at, one.cosine_out);
    const Vec3 first = in.unitOrthogonal();
    for (const Vec3& field : {first, Vec3(in.cross(first))}) {
      const Vec3 expected = slow_fringe(one.source, one.cosine, out, field, in);
      const Vec3 found = fringe_matrix(wedge_of(kTwoPi), in, out) * field;
      EXPECT_LT((found - expected).norm(), 0.01 * (expected.norm() + 0.1)) << one.source << ": " << found << "\n"
                                                                           << expected;
    }
  }
}

// Hankel's functions of the second kind, of the orders 0 and 1, far from 0 (Abramowitz and Stegun 9.2.8).
Complex hankel(int order, double x) {
  const double first = order == 0 ? 1.0 / 8.0 : -3.0 / 8.0;
  return std::sqrt(2.0 / (kPi * x)) * std::polar(1.0, -x + (0.5 * order + 0.25) * kPi) * (1.0 + kJ * first / x);
}

// Holds a field along the edge of unit strength, of both kinds.
struct BothKinds {
  Complex electric, magnetic;
};

// Returns Sommerfeld's exact field beside a half plane at the distance `rho` (1/k) and the angle `at`.
BothKinds sommerfeld(double source, double rho, double at) {
  const auto part = [&](double angle) {
    return std::exp(kJ * rho * std::cos(angle)) * fresnel(-std::sqrt(2.0 * rho) * std::cos(0.5 * angle));
  };
  return {part(at - source) - part(at + source), part(at - source) + part(at + source)};
}

// Returns the incident field and that of the physical optics of the half plane, by a sum over its currents, whose far end
// fades out.
BothKinds physical_optics(double source, double rho, double at) {
  const double step = 0.13, end = 12000.0;
  BothKinds sum{0.0, 0.0};
  const double side = source < kPi ? 1.0 : -1.0;  // of the lit face
  for (double x = 0.5 * step; x < end; x += step) {
    const double fade = x < 0.5 * end ? 1.0 : std::pow(std::cos(kPi * (x / end - 0.5)), 2);
    const Vec3 to(rho * std::cos(at) - x, rho * std::sin(at), 0.0);
    const double r = to.norm();
    const Complex current = 2.0 * fade * step * std::exp(kJ * x * std::cos(source));
    sum.electric -= 0.25 * side * std::sin(source) * current * hankel(0, r);
    sum.magnetic += side * current * hankel(1, r) * to[1] / r / (4.0 * kJ);
  }
  const Complex incident = std::exp(kJ * rho * std::cos(at - source));
  return {incident + sum.electric, incident + sum.magnetic};
}

// Returns the far field of the fringe.
BothKinds fringe(double source, double rho, double at) {
  const Vec3 in = -across(source), out = across(at), edge = Vec3::UnitZ(), upward = in.cross(edge);
  const Mat3 matrix = fringe_matrix(wedge_of(kTwoPi), in, out);
  const Complex scale = -0.25 * kJ * std::sqrt(2.0 / (kPi * rho)) * std::polar(1.0, 0.25 * kPi - rho);
  return {scale * edge.dot(matrix * edge), scale * edge.dot(out.cross(matrix * upward)) / edge.dot(in.cross(upward))};
}

// At 100 wavelengths; transitions reach to 20 degrees from the boundaries of shadow and of reflection.
TEST(HalfPlane, PhysicalOpticsAndFringeAreSommerfeldsHalfPlane) {
  constexpr double kRho = 100.0 * kTwoPi, kInTransition = 0.5, kElsewhere = 0.1;  // dB
  for (const double source : {0.5, 1.1, 2.0, 2.8}) {
    for (double at = 0.5; at < 5.5; at += 0.1931) {
      const BothKinds exact = sommerfeld(source, kRho, at), optics = physical_optics(source, kRho, at);
      const BothKinds edge = fringe(source, kRho, at);
      const double away = std::min(std::abs(at - kPi - source), std::abs(at - kPi + source));
      const double bound = away < 20.0 / 180.0 * kPi ? kInTransition : kElsewhere;
      EXPECT_NEAR(20.0 * std::log10(std::abs((optics.electric + edge.electric) / exact.electric)), 0.0, bound)
          << source << " " << at;
      EXPECT_NEAR(20.0 * std::log10(std::abs((optics.magnetic + edge.magnetic) / exact.magnetic)), 0.0, bound)
          << source << " " << at;
    }
  }
}

}  // namespace
}  // namespace echopath::test_half_plane
