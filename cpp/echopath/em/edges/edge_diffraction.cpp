#include "echopath/em/edges/edge_diffraction.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"

namespace echopath {
namespace {

constexpr double kLeastSine = 1e-3;    // of the angle between a wave and the edge
constexpr double kLeastHeight = 1e-3;  // rad: directions nearer to the plane of a face count as that far off it
constexpr double kOnFace = 1e-9;       // rad: a direction so little inside of a face lies on it
constexpr double kRim = 1e-4;          // rad: the rim of a sheet has an exterior angle of 2 pi within that

// Returns the angle about the edge from a face to a direction, in [0, 2 pi) rad.
double angle_from(const WedgeFace& face, const Vec3& direction) {
  const double angle = std::atan2(direction.dot(face.normal), direction.dot(face.inward));
  if (angle >= 0) return angle;
  return angle > -kOnFace ? 0.0 : angle + kTwoPi;
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
  const auto is_before = [&](const WedgeFace& face) { return direction.dot(face.normal) >= -kOnFace; };
  const bool before_first = is_before(wedge.faces[0]), before_second = is_before(wedge.faces[1]);
  return wedge.exterior_angle > kPi ? before_first || before_second : before_first && before_second;
}

Fringe::Fringe(const Wedge& wedge, const Vec3& in) : wedge_(wedge) {
  if (axis_of(wedge).cross(in).norm() < kLeastSine || !is_outside(wedge, -in)) return;
  const double n = wedge.exterior_angle / kPi, source = angle_about(wedge, -in);
  const auto of_face = [&](int face, double angle) {
    return FaceCurrents(wedge.faces[face], n, angle, angle < kPi ? 2.0 : 0.0, in);
  };
  faces_ = {of_face(0, source), of_face(1, wedge.exterior_angle - source)};
}

Mat3 Fringe::toward(const Vec3& direction) const {
  const Vec3 out = off_faces(wedge_, direction);
  if (!faces_ || !is_outside(wedge_, out)) return Mat3::Zero();
  const Mat3 currents = (*faces_)[0].toward(out) + (*faces_)[1].toward(out);
  return currents - out * (out.transpose() * currents);
}

Vec3 field_of_grazing_wave(const Wedge& wedge, int face, const Vec3& along, const Vec3& toward) {
  const Vec3 out = off_faces(wedge, toward);
  const double sine = axis_of(wedge).cross(along).norm();
  if (sine < kLeastSine || !is_outside(wedge, out)) return Vec3::Zero();
  const double n = wedge.exterior_angle / kPi;
  const Mat3 fringe = FaceCurrents(wedge.faces[face], n, 0.0, 2.0, along).toward(out) +
                      FaceCurrents(wedge.faces[1 - face], n, wedge.exterior_angle, 0.0, along).toward(out);
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
