#include "echopath/em/edge_shadow.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"

namespace echopath {
namespace {

constexpr double kLeastAcross = 1e-3;  // sine of the angle between a wave and the edge
constexpr double kLargeArgument = 2.0;
constexpr double kLeastOffBoundary = 1e-6;  // rad: nearer to a boundary counts as that far off it

// Returns what remains of a coefficient in the transition, where `within` half Fresnel zones lie between the boundary and
// the direction. Uses the auxiliary functions f and g of Fresnel's integrals, times pi x: Abramowitz and Stegun (1964),
// 7.3.27 and 7.3.28 where x is large, else 7.3.32 and 7.3.33, to 1e-2.
std::complex<double> transition(double within) {
  const double x = std::sqrt(2.0) * within;
  if (x > kLargeArgument) {
    const double inverse = 1.0 / (kPi * x * x), square = inverse * inverse;
    return {1.0 - square * (3.0 - 105.0 * square), inverse * (1.0 - square * (15.0 - 945.0 * square))};
  }
  const double f = (1.0 + 0.926 * x) / (2.0 + x * (1.792 + x * 3.104));
  const double g = 1.0 / (2.0 + x * (4.142 + x * (3.492 + x * 6.670)));
  return kPi * x * std::complex<double>(f, g);
}

// One of Keller's cotangents with its transition: its boundary lies where `off` (rad) is zero, and n is the exterior angle
// over pi. `zone` is the number of half Fresnel zones per sine of half of `off`.
struct Term {
  double off, n, zone;

  double within() const { return zone * std::abs(std::sin(0.5 * off)); }
  std::complex<double> value() const {
    const double apart = std::abs(off) < kLeastOffBoundary ? std::copysign(kLeastOffBoundary, off) : off;
    return transition(zone * std::abs(std::sin(0.5 * apart))) / std::tan(0.5 * apart / n);
  }
  std::complex<double> faded() const { return value() * -std::expm1(-kPi * within() * within()); }
};

}  // namespace

Eigen::Matrix3cd diffraction_matrix(const Wedge& wedge, const Vec3& in, const Vec3& out, double phase) {
  const Vec3 axis = wedge.faces[0].inward.cross(wedge.faces[0].normal);
  const Vec3 across_in = axis.cross(in), across_out = axis.cross(out);
  const double sine = across_in.norm();
  if (std::min(sine, across_out.norm()) < kLeastAcross || !is_outside(wedge, -in) || !is_outside(wedge, out))
    return Eigen::Matrix3cd::Zero();
  const auto angle = [&](const Vec3& direction) {
    const double about = std::atan2(direction.dot(wedge.faces[0].normal), direction.dot(wedge.faces[0].inward));
    return std::clamp(about < 0 ? about + kTwoPi : about, 0.0, wedge.exterior_angle);
  };
  const double n = wedge.exterior_angle / kPi, zone = std::sqrt(2.0 * phase / kPi) * sine;
  const double turn = angle(out) - angle(-in), sum = angle(out) + angle(-in);
  const std::complex<double> shadow = Term{kPi + turn, n, zone}.value() + Term{kPi - turn, n, zone}.value();
  const std::complex<double> reflection =
      Term{kPi - sum, n, zone}.faded() + Term{kPi + sum - 2.0 * wedge.exterior_angle, n, zone}.faded();
  const Vec3 phi_in = across_in / sine, phi_out = across_out.normalized();
  const Mat3 along = phi_out.cross(out) * phi_in.cross(in).transpose(), around = phi_out * phi_in.transpose();
  return ((reflection - shadow) * along.cast<std::complex<double>>() -
          (reflection + shadow) * around.cast<std::complex<double>>()) /
         n;
}

}  // namespace echopath
