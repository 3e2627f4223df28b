#include "echopath/motion/curve_motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "echopath/base/errors.h"

namespace echopath {
namespace {

// A quaternion farther from length 1 than this is a mistake; 8-bit ones are off by 0.7 %.
constexpr double kKeyLengthTolerance = 1e-2;
// A quaternion nearer to length 1 than this is left alone, so that saved ones keep their bits.
constexpr double kKeyLengthRounding = 1e-14;

Quaternion quaternion_at(const std::vector<double>& values, size_t key) {
  const double* q = values.data() + 4 * key;
  return {q[0], q[1], q[2], q[3]};
}

// Normalises the keys. Those of splines stay as they are, because only what lies between them is normalised.
void normalise_keys(Curve& curve) {
  for (size_t k = 0; k < curve.times.size(); ++k) {
    const double norm = quaternion_at(curve.values, k).norm();
    require(std::abs(norm - 1.0) <= kKeyLengthTolerance, "rotation", "must hold unit quaternions (w, x, y, z); norm", norm);
    if (curve.interpolation == CurveInterpolation::kHermite || std::abs(norm - 1.0) <= kKeyLengthRounding) continue;
    for (size_t c = 4 * k; c < 4 * k + 4; ++c) curve.values[c] /= norm;
  }
}

// Returns whether all keys are one rotation, whose quaternions are q and -q; splines between these pass through others.
bool is_one_rotation(const Curve& curve) {
  if (curve.interpolation == CurveInterpolation::kHermite) return curve.is_constant();
  const Eigen::Vector4d first = quaternion_at(curve.values, 0).coeffs();
  for (size_t k = 1; k < curve.times.size(); ++k) {
    const Eigen::Vector4d key = quaternion_at(curve.values, k).coeffs();
    if (key != first && key != -first) return false;
  }
  return true;
}

Vec3 vector_at(const Curve& curve, const Playback& playback, double time) {
  Vec3 value;
  evaluate(curve, playback, time, {value.data(), 3});
  return value;
}

Quaternion rotation_at(const Curve& curve, const Playback& playback, double time) {
  const CurvePlace place = place_on(curve, playback, time);
  if (curve.interpolation == CurveInterpolation::kLinear) {
    return quaternion_at(curve.values, place.k).slerp(place.s, quaternion_at(curve.values, place.next));
  }
  std::array<double, 4> q;
  evaluate(curve, playback, time, q);
  const Quaternion value(q[0], q[1], q[2], q[3]);
  return value.norm() > 0.0 ? value.normalized() : quaternion_at(curve.values, place.k);
}

// Returns a bound of the angular speed between two keys, rad/s. The derivative of a Hermite spline lies in the hull of
// three vectors (its Bezier form), and its length is seen at some places.
double angular_speed(const Curve& curve, size_t k) {
  if (curve.interpolation == CurveInterpolation::kStep) return 0.0;
  const double step = curve.times[k + 1] - curve.times[k];
  const Quaternion from = quaternion_at(curve.values, k), to = quaternion_at(curve.values, k + 1);
  if (curve.interpolation == CurveInterpolation::kLinear) return from.angularDistance(to) / step;
  constexpr int kPlaces = 16;
  constexpr double kShortest = 0.05;  // keys more than 170 degrees apart come near 0
  const Quaternion leaving = quaternion_at(curve.out_tangents, k), arriving = quaternion_at(curve.in_tangents, k + 1);
  const Eigen::Vector4d middle = 3.0 * (to.coeffs() - from.coeffs()) / step - leaving.coeffs() - arriving.coeffs();
  double shortest = 1.0;
  for (int i = 1; i < kPlaces; ++i) {
    const auto w = curve_weights(curve, {k, k + 1, static_cast<double>(i) / kPlaces});
    const Eigen::Vector4d q = w[0] * from.coeffs() + w[1] * leaving.coeffs() + w[2] * to.coeffs() + w[3] * arriving.coeffs();
    shortest = std::min(shortest, q.norm());
  }
  const double fastest = std::max({leaving.norm(), middle.norm(), arriving.norm()});
  return 2.0 * fastest / std::max(shortest, kShortest);
}

}  // namespace

CurveMotion::CurveMotion(MotionCurves curves, const Playback& playback) : curves_(std::move(curves)), playback_(playback) {
  playback.validate();
  require(curves_.translation || curves_.rotation || curves_.scale, "translation",
          "must be given where there is neither rotation nor scale", "none");
  if (curves_.translation) curves_.translation->validate("translation", 3);
  if (curves_.rotation) {
    curves_.rotation->validate("rotation", 4);
    normalise_keys(*curves_.rotation);
  }
  if (curves_.scale) curves_.scale->validate("scale", 3);
  const auto is_constant = [](const std::optional<Curve>& curve) { return !curve || curve->is_constant(); };
  rests_ = is_constant(curves_.translation) && is_constant(curves_.scale) &&
           (!curves_.rotation || is_one_rotation(*curves_.rotation));
}

Transform CurveMotion::at(double time) const {
  if (rests_) time = time_at_rest(time);
  Transform transform = Transform::Identity();
  if (curves_.translation) transform.translation() = vector_at(*curves_.translation, playback_, time);
  if (curves_.rotation) transform.linear() = rotation_at(*curves_.rotation, playback_, time).toRotationMatrix();
  if (curves_.scale) transform.linear() *= vector_at(*curves_.scale, playback_, time).asDiagonal();
  return transform;
}

std::vector<double> CurveMotion::breakpoints(const TimeSpan& during) const {
  std::vector<double> times;
  for (const std::optional<Curve>* curve : {&curves_.translation, &curves_.rotation, &curves_.scale}) {
    if (*curve) playback_.append_times((*curve)->times, during, times);
  }
  std::ranges::sort(times);
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

double CurveMotion::turn_rate(const TimeSpan& during) const {
  double fastest = 0.0;
  if (curves_.translation) fastest = curve_turn_rate(*curves_.translation, playback_, during);
  if (curves_.scale) fastest = std::max(fastest, curve_turn_rate(*curves_.scale, playback_, during));
  if (!curves_.rotation) return fastest;
  const auto [first, last] = keys_played(*curves_.rotation, playback_, during);
  for (size_t k = first; k < last; ++k) fastest = std::max(fastest, angular_speed(*curves_.rotation, k));
  return fastest;
}

}  // namespace echopath
