#include "echopath/em/edges/edge_diffraction.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"

namespace echopath {
namespace {

constexpr double kLeastSine = 1e-3;     // of the angle between a wave and the edge
constexpr double kLeastHeight = 1e-3;   // rad: directions nearer to the plane of a face count as that far off it
constexpr double kOnFace = 1e-9;        // rad: a direction so little inside of a face lies on it
constexpr double kLeastApart = 1e-5;    // rad: nearer to a boundary, the difference of two poles is taken from there
constexpr double kRim = 1e-4;           // rad: the rim of a sheet has an exterior angle of 2 pi within that
constexpr double kLeastForward = 1e-6;  // sine of the angle to the grazing ray, where a coefficient ends to grow

// Returns the angle about the edge from a face to a direction, in [0, 2 pi) rad.
double angle_from(const WedgeFace& face, const Vec3& direction) {
  const double angle = std::atan2(direction.dot(face.normal), direction.dot(face.inward));
  if (angle >= 0) return angle;
  return angle > -kOnFace ? 0.0 : angle + kTwoPi;
}

// Holds functions of w, where cos w = c: sin(w/n)/sin w, and cos of a/n and of a less those of w/n and of w, for an angle a.
// For c > 1 the angle w is imaginary and all of them are real.
struct AtAngle {
  double ratio, difference_of_parts, difference;
};

AtAngle at_angle(double c, double n, double& angle) {
  if (c > 1.0) {
    const double w = std::max(std::acosh(c), kLeastApart);
    const auto difference = [&](double part) {
      const double real = std::sin(0.5 * angle / part), imaginary = std::sinh(0.5 * w / part);
      return -2.0 * (real * real + imaginary * imaginary);
    };
    return {std::sinh(w / n) / std::sinh(w), difference(n), difference(1.0)};
  }
  const double w = std::acos(std::max(c, -1.0));
  if (std::abs(w - angle) < kLeastApart) angle = w < 0.5 ? w + kLeastApart : w - kLeastApart;
  const auto difference = [&](double part) {
    return -2.0 * std::sin(0.5 * (angle + w) / part) * std::sin(0.5 * (angle - w) / part);
  };
  const double sine = w < 0.5 * kPi ? std::sin(w) : std::max(std::sin(w), kLeastForward);
  return {sine > 0 ? std::sin(w / n) / sine : 1.0 / n, difference(n), difference(1.0)};
}

// Returns the part of the matrix that one face makes. `angle` is that of the source, from this face; `n` is the exterior
// angle over pi. The integrals of a current's two components along the strip are those of the exact solution less `lit`
// times those of the incident field: 2 for physical optics on a lit face. `at_edge` is what the current across the edge
// leaves there.
Mat3 currents_of_face(const WedgeFace& face, double n, double angle, double lit, const Vec3& in, const Vec3& out) {
  const Vec3 edge = face.inward.cross(face.normal);
  const double cosine = in.dot(edge), sine = std::sqrt(1.0 - cosine * cosine);
  const double mu = (out.dot(sine * face.inward + cosine * edge) - cosine * cosine) / (sine * sine);
  const AtAngle at = at_angle(-mu, n, angle);
  const double across = (2.0 * at.ratio / (n * at.difference_of_parts) - lit / at.difference) / sine;
  const double along =
      (2.0 * std::sin(angle / n) / (n * at.difference_of_parts) - lit * std::sin(angle) / at.difference) / sine;
  const double at_edge = 2.0 / n - lit;
  const Vec3 magnetic = edge.cross(in);
  const double of_magnetic = (mu * across - at_edge / sine) * cosine / sine;
  return face.inward * across * magnetic.transpose() + edge * (along / sine * edge + of_magnetic * magnetic).transpose();
}

// Returns a direction near the plane of a face as one a little off it. Toward the grazing ray itself the coefficient depends
// on how the ray is approached; the field across a sheet that is seen along itself is the limit of directions off its plane.
Vec3 off_faces(const Wedge& wedge, const Vec3& direction) {
  for (const WedgeFace& face : wedge.faces) {
    const double height = direction.dot(face.normal);
    if (height >= -kOnFace && height < kLeastHeight && direction.dot(face.inward) > 0)
      return (direction + (kLeastHeight - height) * face.normal).normalized();
  }
  return direction;
}

}  // namespace

Wedge wedge_between(const WedgeFace& first, const WedgeFace& second) {
  const double angle = angle_from(first, second.inward);
  return {{first, second}, angle > kOnFace ? angle : kTwoPi};
}

bool is_rim(const Wedge& wedge) { return wedge.exterior_angle > kTwoPi - kRim; }

Vec3 axis_of(const Wedge& wedge) { return wedge.faces[0].inward.cross(wedge.faces[0].normal); }

bool is_outside(const Wedge& wedge, const Vec3& direction) {
  return angle_from(wedge.faces[0], direction) <= wedge.exterior_angle + kOnFace;
}

Mat3 fringe_matrix(const Wedge& wedge, const Vec3& in, const Vec3& toward) {
  const Vec3 out = off_faces(wedge, toward);
  const Vec3 edge = axis_of(wedge);
  if (edge.cross(in).norm() < kLeastSine || !is_outside(wedge, -in) || !is_outside(wedge, out)) return Mat3::Zero();
  const double n = wedge.exterior_angle / kPi;
  const double first = std::min(angle_from(wedge.faces[0], -in), wedge.exterior_angle),
               second = wedge.exterior_angle - first;
  const auto lit = [](double angle) { return angle < kPi ? 2.0 : 0.0; };
  const Mat3 currents = currents_of_face(wedge.faces[0], n, first, lit(first), in, out) +
                        currents_of_face(wedge.faces[1], n, second, lit(second), in, out);
  return currents - out * (out.transpose() * currents);
}

Vec3 field_of_grazing_wave(const Wedge& wedge, int face, const Vec3& along, const Vec3& toward) {
  const Vec3 out = off_faces(wedge, toward);
  const double sine = axis_of(wedge).cross(along).norm();
  if (sine < kLeastSine || !is_outside(wedge, out)) return Vec3::Zero();
  const double n = wedge.exterior_angle / kPi;
  const Mat3 fringe = currents_of_face(wedge.faces[face], n, 0.0, 2.0, along, out) +
                      currents_of_face(wedge.faces[1 - face], n, wedge.exterior_angle, 0.0, along, out);
  // The current of the wave itself is twice its magnetic field, and ends at the edge.
  const Vec3 currents = fringe * wedge.faces[face].normal + 2.0 * sine / (1.0 - along.dot(out)) * along;
  return currents - out * out.dot(currents);
}

double grazing_coefficient(double exterior_angle, double source, double at) {
  const double n = exterior_angle / kPi, at_shadow = std::cos(kPi / n);
  return std::sin(kPi / n) / n *
         (1.0 / (at_shadow - std::cos((at - source) / n)) + 1.0 / (at_shadow - std::cos((at + source) / n)));
}

double angle_about(const Wedge& wedge, const Vec3& direction) {
  return std::min(angle_from(wedge.faces[0], direction), wedge.exterior_angle);
}

std::complex<double> edge_filter(double linear_phase, double quadratic_phase) {
  const double x = std::abs(0.5 * linear_phase), x2 = x * x;
  // These are the means of s^0, s^2 and s^4 times cos(xs) over s in [0, 1].
  double mean0, mean2, mean4;
  if (x < 0.2) {
    mean0 = 1.0 - x2 / 6.0 + x2 * x2 / 120.0;
    mean2 = 1.0 / 3.0 - x2 / 10.0 + x2 * x2 / 168.0;
    mean4 = 1.0 / 5.0 - x2 / 14.0 + x2 * x2 / 216.0;
  } else {
    const double sine = std::sin(x) / x, cosine = std::cos(x);
    mean0 = sine;
    mean2 = sine + 2.0 * (cosine - sine) / x2;
    mean4 = sine + 4.0 * (cosine - 3.0 * mean2) / x2;
  }
  return {mean0 - 0.5 * quadratic_phase * quadratic_phase * mean4, -quadratic_phase * mean2};
}

}  // namespace echopath
