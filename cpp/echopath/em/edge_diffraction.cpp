#include "echopath/em/edge_diffraction.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"

namespace echopath {
namespace {

constexpr double kLeastSine = 1e-3;     // of the angle between a wave and the edge
constexpr double kLeastHeight = 1e-3;   // rad: directions nearer to the plane of a face count as that far off it
constexpr double kOnFace = 1e-9;        // rad: a direction so little inside of a face lies on it
constexpr double kLeastApart = 1e-5;    // rad: nearer to a boundary, the difference of two poles is taken from there
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
    const double w = std::acosh(c), sine = std::sinh(w);
    const double ratio = sine > 0 ? std::sinh(w / n) / sine : 1.0 / n;
    return {ratio, std::cos(angle / n) - std::cosh(w / n), std::cos(angle) - c};
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
// angle over pi. The integrals of a current's two components along the strip are those of the exact solution less those of
// physical optics, as far as the face is lit; `at_edge` is what the current across the edge leaves there.
Mat3 fringe_of_face(const WedgeFace& face, double n, double angle, const Vec3& in, const Vec3& out) {
  const Vec3 edge = face.inward.cross(face.normal);
  const double cosine = in.dot(edge), sine = std::sqrt(1.0 - cosine * cosine);
  const double mu = (out.dot(sine * face.inward + cosine * edge) - cosine * cosine) / (sine * sine);
  const double lit = angle < kPi ? 2.0 : 0.0;
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

bool is_outside(const Wedge& wedge, const Vec3& direction) {
  return angle_from(wedge.faces[0], direction) <= wedge.exterior_angle + kOnFace;
}

Mat3 fringe_matrix(const Wedge& wedge, const Vec3& in, const Vec3& toward) {
  const Vec3 out = off_faces(wedge, toward);
  const Vec3 edge = wedge.faces[0].inward.cross(wedge.faces[0].normal);
  if (edge.cross(in).norm() < kLeastSine || !is_outside(wedge, -in) || !is_outside(wedge, out)) return Mat3::Zero();
  const double n = wedge.exterior_angle / kPi;
  const double first = std::min(angle_from(wedge.faces[0], -in), wedge.exterior_angle),
               second = wedge.exterior_angle - first;
  const Mat3 currents =
      fringe_of_face(wedge.faces[0], n, first, in, out) + fringe_of_face(wedge.faces[1], n, second, in, out);
  return currents - out * (out.transpose() * currents);
}

double edge_filter(double phase) {
  const double half = 0.5 * phase;
  return std::abs(half) < 1e-4 ? 1.0 - half * half / 6.0 : std::sin(half) / half;
}

}  // namespace echopath
