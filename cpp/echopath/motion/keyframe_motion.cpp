#include <algorithm>
#include <cmath>
#include <utility>

#include "echopath/base/errors.h"
#include "echopath/base/geometry.h"
#include "echopath/motion/spline.h"

namespace echopath {
namespace {

// A quaternion nearer to length 1 than this is left alone, so that saved ones keep their bits.
constexpr double kUnitRounding = 1e-14;

void check_translations(const std::vector<Vec3>& translations, size_t num_times) {
  if (translations.empty()) return;
  require(translations.size() == num_times, "translations", "must be as many as times", translations.size());
  for (const Vec3& value : translations) require(value.allFinite(), "translations", "must be finite", value.transpose());
}

// Normalises the quaternions and puts neighbours in one half space: q and -q are one rotation, but not to an interpolation.
std::vector<Quaternion> continuous(std::vector<Quaternion> rotations, size_t num_times) {
  if (rotations.empty()) return rotations;
  require(rotations.size() == num_times, "rotations", "must be as many as times", rotations.size());
  for (size_t i = 0; i < rotations.size(); ++i) {
    const double norm = rotations[i].norm();
    require(std::abs(norm - 1.0) <= kUnitTolerance, "rotations", "must be unit quaternions (w, x, y, z); norm", norm);
    if (std::abs(norm - 1.0) > kUnitRounding) rotations[i].coeffs() /= norm;
    if (i > 0 && rotations[i].dot(rotations[i - 1]) < 0.0) rotations[i].coeffs() *= -1.0;
  }
  return rotations;
}

// Returns the derivatives of `samples` at the knots, of SplineKnots::derivatives, in the same type.
template <class Value>
std::vector<Value> key_derivatives(const SplineKnots& knots, const std::vector<Value>& samples) {
  if (samples.empty() || !knots.has_derivatives()) return {};
  std::vector<Value> result(samples.size());
  std::vector<const double*> rows;
  std::vector<double*> out;
  for (size_t i = 0; i < samples.size(); ++i) {
    rows.push_back(reinterpret_cast<const double*>(&samples[i]));
    out.push_back(reinterpret_cast<double*>(&result[i]));
  }
  knots.derivatives(rows, 1, sizeof(Value) / sizeof(double), out);
  return result;
}

}  // namespace

struct KeyframeMotion::Data {
  SplineKnots knots;
  std::vector<Vec3> translations, translation_derivatives;
  std::vector<Quaternion> rotations, rotation_derivatives;
  bool rests;

  Vec3 translation(const SplineKnots::Weights& w) const {
    if (translations.empty()) return Vec3::Zero();
    Vec3 value = w.value[0] * translations[w.k] + w.value[1] * translations[w.k + 1];
    if (knots.has_derivatives()) {
      value += w.derivative[0] * translation_derivatives[w.k] + w.derivative[1] * translation_derivatives[w.k + 1];
    }
    return value;
  }

  // Returns a bound of the angular speed between knots k and k + 1, rad/s: twice the speed of the unit quaternion. Its C2
  // spline has the derivative of the chord plus at most h / 3 times the second derivatives at its ends, and is never
  // shorter than the chord.
  double angular_speed(size_t k) const {
    constexpr double kMinQuaternionLength = 0.7071;  // between rotations less than 180 degrees apart
    const double step = knots.times()[k + 1] - knots.times()[k];
    if (knots.interpolation() == Interpolation::kLinear) return rotations[k].angularDistance(rotations[k + 1]) / step;
    const Eigen::Vector4d chord = (rotations[k + 1].coeffs() - rotations[k].coeffs()) / step;
    if (!knots.has_derivatives()) return 2.0 * chord.norm() / kMinQuaternionLength;
    const Eigen::Vector4d &before = rotation_derivatives[k].coeffs(), &after = rotation_derivatives[k + 1].coeffs();
    if (knots.interpolation() == Interpolation::kMonotone) return monotone_angular_speed(k, step, chord, before, after);
    return 2.0 * (chord.norm() + step / 3.0 * (before.norm() + after.norm())) / kMinQuaternionLength;
  }

  // The same of kMonotone, a bound but where the curve comes near no rotation at all, of the chord's derivative and those
  // at the two knots, per s: a cubic lies in the hull of its four control points, and its derivative in the hull of their
  // three differences.
  double monotone_angular_speed(size_t k, double step, const Eigen::Vector4d& chord, const Eigen::Vector4d& before,
                                const Eigen::Vector4d& after) const {
    constexpr double kLeastLength = 0.05;  // of keys that are nearly 180 degrees apart
    const Eigen::Vector4d &first = rotations[k].coeffs(), &second = rotations[k + 1].coeffs();
    const Eigen::Vector4d middle = (first + second).normalized();
    const double length = std::min({middle.dot(first), middle.dot(first + step / 3.0 * before),
                                    middle.dot(second - step / 3.0 * after), middle.dot(second)});
    const double speed = std::max({before.norm(), (3.0 * chord - before - after).norm(), after.norm()});
    return 2.0 * speed / std::max(length, kLeastLength);
  }

  Quaternion rotation(const SplineKnots::Weights& w) const {
    if (rotations.empty()) return Quaternion::Identity();
    const Quaternion &first = rotations[w.k], &second = rotations[w.k + 1];
    if (knots.interpolation() == Interpolation::kLinear) return first.slerp(w.value[1], second);
    Quaternion value(first.coeffs() * w.value[0] + second.coeffs() * w.value[1]);
    if (knots.has_derivatives()) {
      value.coeffs() += w.derivative[0] * rotation_derivatives[w.k].coeffs();
      value.coeffs() += w.derivative[1] * rotation_derivatives[w.k + 1].coeffs();
    }
    return value.normalized();
  }
};

KeyframeMotion::KeyframeMotion(std::vector<double> times, std::vector<Vec3> translations, std::vector<Quaternion> rotations,
                               Interpolation interpolation) {
  SplineKnots knots(std::move(times), interpolation);
  require(!translations.empty() || !rotations.empty(), "translations", "must be given where there are no rotations",
          "neither");
  check_translations(translations, knots.times().size());
  rotations = continuous(std::move(rotations), knots.times().size());
  std::vector<Vec3> translation_derivatives = key_derivatives(knots, translations);
  std::vector<Quaternion> rotation_derivatives = key_derivatives(knots, rotations);
  const bool rests = all_equal(translations) && all_equal(rotations);
  data_ = std::make_shared<const Data>(Data{std::move(knots), std::move(translations), std::move(translation_derivatives),
                                            std::move(rotations), std::move(rotation_derivatives), rests});
}

Transform KeyframeMotion::at(double time) const {
  const SplineKnots::Weights weights = data_->knots.weights(time, data_->rests);
  Transform transform = Transform::Identity();
  transform.translation() = data_->translation(weights);
  transform.linear() = data_->rotation(weights).toRotationMatrix();
  return transform;
}

std::vector<double> KeyframeMotion::breakpoints(const TimeSpan&) const { return data_->knots.breakpoints(); }
bool KeyframeMotion::rests() const { return data_->rests; }
TimeSpan KeyframeMotion::span() const { return data_->knots.span(); }

double KeyframeMotion::turn_rate(const TimeSpan& during) const {
  const std::vector<double>& times = data_->knots.times();
  const auto [first, last] = knots_around(times, during);
  TurningPoints turns;
  for (size_t k = first; k <= last && !data_->translations.empty(); ++k) turns.add(times[k], data_->translations[k]);
  double fastest = turns.rate();
  for (size_t k = first; k < last && !data_->rotations.empty(); ++k) fastest = std::max(fastest, data_->angular_speed(k));
  return fastest;
}

const std::vector<double>& KeyframeMotion::times() const { return data_->knots.times(); }
const std::vector<Vec3>& KeyframeMotion::translations() const { return data_->translations; }
const std::vector<Quaternion>& KeyframeMotion::rotations() const { return data_->rotations; }
Interpolation KeyframeMotion::interpolation() const { return data_->knots.interpolation(); }

}  // namespace echopath
