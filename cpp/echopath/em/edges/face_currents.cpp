#include "echopath/em/edges/face_currents.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"

namespace echopath {
namespace {

constexpr double kLeastApart = 1e-5;    // rad: nearer to a boundary, the difference of two poles is taken from there
constexpr double kApart = 0.05;         // rad: sines of sums of angles are exact enough for poles that are so far apart
constexpr double kLeastForward = 1e-6;  // sine of the angle to the grazing ray, where a coefficient ends to grow

}  // namespace

FaceCurrents::SineCosine::SineCosine(double angle) : sine(std::sin(angle)), cosine(std::cos(angle)) {}

// Holds functions of w, where cos w is given: sin(w/n)/sin w, and cos of a/n and of a less those of w/n and of w, for the
// angle a of the source, with the sines of a/n and of a. Where cos w > 1 the angle w is imaginary and all of them are real.
struct FaceCurrents::AtAngle {
  double ratio, difference_of_parts, difference, sine_of_part, sine;
};

FaceCurrents::FaceCurrents(const WedgeFace& face, double n, double angle, double lit, const Vec3& in)
    : inward_(face.inward), edge_(face.inward.cross(face.normal)), magnetic_(edge_.cross(in)), n_(n), lit_(lit),
      cosine_(in.dot(edge_)), sine_(std::sqrt(1.0 - cosine_ * cosine_)), angle_(angle), source_(angle, n) {
  ahead_ = sine_ * inward_ + cosine_ * edge_;
}

// Returns these functions at a real w, near to the source. Poles so near to each other are told apart by their angles.
FaceCurrents::AtAngle FaceCurrents::beside_source(double w) const {
  const bool is_there = std::abs(w - angle_) < kLeastApart;
  const double angle = !is_there ? angle_ : w < 0.5 ? w + kLeastApart : w - kLeastApart;
  const auto difference = [&](double part) {
    return -2.0 * std::sin(0.5 * (angle + w) / part) * std::sin(0.5 * (angle - w) / part);
  };
  const double sine = w < 0.5 * kPi ? std::sin(w) : std::max(std::sin(w), kLeastForward);
  return {sine > 0 ? std::sin(w / n_) / sine : 1.0 / n_, difference(n_), difference(1.0), std::sin(angle / n_),
          std::sin(angle)};
}

FaceCurrents::AtAngle FaceCurrents::at(double cosine) const {
  const double of_part = source_.part.of_twice(), of_source = source_.half.of_twice();
  if (cosine > 1.0) {
    const double w = std::max(std::acosh(cosine), kLeastApart), half = std::sinh(0.5 * w), part = std::sinh(0.5 * w / n_);
    const auto difference = [](double real, double imaginary) { return -2.0 * (real * real + imaginary * imaginary); };
    return {part / half * std::sqrt((1.0 + part * part) / (1.0 + half * half)), difference(source_.part.sine, part),
            difference(source_.half.sine, half), of_part, of_source};
  }
  const double w = std::acos(std::max(cosine, -1.0));
  if (std::abs(w - angle_) < kApart) return beside_source(w);
  const Halves at(w, n_);
  const auto difference = [](const SineCosine& a, const SineCosine& b) {
    const double one = a.sine * b.cosine, other = a.cosine * b.sine;
    return -2.0 * (one + other) * (one - other);
  };
  const double sine = w < 0.5 * kPi ? at.half.of_twice() : std::max(at.half.of_twice(), kLeastForward);
  return {sine > 0 ? at.part.of_twice() / sine : 1.0 / n_, difference(source_.part, at.part),
          difference(source_.half, at.half), of_part, of_source};
}

// `at_edge` is what the current across the edge leaves there.
Mat3 FaceCurrents::toward(const Vec3& out) const {
  const double mu = (out.dot(ahead_) - cosine_ * cosine_) / (sine_ * sine_);
  const AtAngle at_mu = at(-mu);
  const double exact = 2.0 / (n_ * at_mu.difference_of_parts), optics = lit_ > 0 ? lit_ / at_mu.difference : 0.0;
  const double across = (exact * at_mu.ratio - optics) / sine_;
  const double along = (exact * at_mu.sine_of_part - optics * at_mu.sine) / sine_;
  const double at_edge = 2.0 / n_ - lit_;
  const double of_magnetic = (mu * across - at_edge / sine_) * cosine_ / sine_;
  return (across * inward_ + of_magnetic * edge_) * magnetic_.transpose() + along / sine_ * edge_ * edge_.transpose();
}

}  // namespace echopath
