#include "echopath/em/edges/edge_shadow.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/em/edges/transition.h"

namespace echopath {
namespace {

constexpr double kLeastAcross = 1e-3;       // sine of the angle between a wave and the edge
constexpr double kLeastOffBoundary = 1e-6;  // rad: nearer to a boundary counts as that far off it

// Is one of Keller's cotangents with its transition: its boundary lies where `off` (rad) is zero, and n is the exterior
// angle over pi. `zone` is the number of half Fresnel zones per sine of half of `off`.
struct Term {
  double off, n, zone;

  double within() const { return zone * std::abs(std::sin(0.5 * off)); }
  std::complex<double> value() const {
    const double apart = std::abs(off) < kLeastOffBoundary ? std::copysign(kLeastOffBoundary, off) : off;
    const double zones = zone * std::sin(0.5 * apart);
    return transition(kPi * zones * zones) / std::tan(0.5 * apart / n);
  }
  std::complex<double> faded() const { return value() * -std::expm1(-kPi * within() * within()); }
};

}  // namespace

Eigen::Matrix3cd diffraction_matrix(const Wedge& wedge, const Vec3& in, const Vec3& out, double phase) {
  const Vec3 axis = axis_of(wedge);
  const Vec3 across_in = axis.cross(in), across_out = axis.cross(out);
  const double sine = across_in.norm();
  if (std::min(sine, across_out.norm()) < kLeastAcross || !is_outside(wedge, -in) || !is_outside(wedge, out))
    return Eigen::Matrix3cd::Zero();
  const double n = wedge.exterior_angle / kPi, zone = std::sqrt(2.0 * phase / kPi) * sine;
  const double source = angle_about(wedge, -in), at = angle_about(wedge, out), turn = at - source, sum = at + source;
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
