#pragma once
// Moves a node by curves, one for the translation, one for the rotation and one for the scale, each with keys of its own.
#include <optional>

#include "echopath/motion/curve.h"

namespace echopath {

// Holds what a CurveMotion is made of. A curve that is not given stands for no translation, no rotation or no scale.
struct MotionCurves {
  std::optional<Curve> translation;  // [T, 3] m
  std::optional<Curve> rotation;     // [T, 4] quaternions (w, x, y, z)
  std::optional<Curve> scale;        // [T, 3]
};

// at(t) = Translation * Rotation * Scale of the curves as `playback` shows them, defined at every time. Straight rotations
// are spherical interpolations the shorter way; those of Hermite splines are normalised (glTF 2.0, appendix C). Its
// breakpoints are all keys of its curves and the ends of runs. Immutable.
class CurveMotion : public Motion {
 public:
  // Quaternions may be off unit length by 1e-2, as files keep them in few bits. Raises invalid_argument naming the argument.
  explicit CurveMotion(MotionCurves curves, const Playback& playback = {});
  Transform at(double time) const override;
  std::vector<double> breakpoints(const TimeSpan& during = {}) const override;
  bool is_rigid() const override { return !curves_.scale; }
  bool rests() const override { return rests_; }  // all curves are constant
  double turn_rate(const TimeSpan& during) const override;
  const MotionCurves& curves() const { return curves_; }
  const Playback& playback() const { return playback_; }

 private:
  MotionCurves curves_;
  Playback playback_;
  bool rests_;
};

}  // namespace echopath
