#pragma once
// A motion maps time to a transform, mostly a rigid one, in the axes of the parent of its node, about the node's own origin.
#include <memory>
#include <vector>

#include "echopath/base/geometry.h"

namespace echopath {

// Holds the closed interval of times, in s, on which a motion is defined.
struct TimeSpan {
  double begin = -1e300;  // s
  double end = 1e300;     // s
};

enum class Interpolation { kCubic, kLinear, kMonotone };

class Motion {
 public:
  virtual ~Motion() = default;
  // Returns the transform at `time` (s), in the axes of the node's parent about the node's origin; `moved` applies it to a
  // placement.
  // Raises invalid_argument when `time` lies outside span().
  virtual Transform at(double time) const = 0;
  // Returns the times (s) where the motion is not smooth, ascending, without the ends of the span: all those within
  // `during`, and others where that is easier. Of a loop without end an unlimited `during` stands for one run.
  virtual std::vector<double> breakpoints(const TimeSpan& during = {}) const {
    static_cast<void>(during);
    return {};
  }
  // Tells whether at(t) keeps lengths at every time. Others move joints of a Skin, but no nodes.
  virtual bool is_rigid() const { return true; }
  // Tells whether at(t) has the same bits at all times of the span, as at a speed of 0: what such a motion moves, stands.
  virtual bool rests() const { return false; }
  virtual TimeSpan span() const { return {}; }
  // Returns a bound (rad/s) of how fast the motion oscillates within `during`: the larger of its angular speed and, where it
  // moves to and fro between samples, pi over the shortest time between two turning points. 0 means that it goes straight
  // on.
  virtual double turn_rate(const TimeSpan& during) const = 0;
};

// Moves at a constant velocity and turns at a constant rate: at(t) = Translation(velocity t) * Rotation(angular_velocity t).
class LinearMotion : public Motion {
 public:
  // velocity [m/s]; angular_velocity [rad/s], right-handed about its own direction. Values must be finite.
  explicit LinearMotion(const Vec3& velocity, const Vec3& angular_velocity = Vec3::Zero());
  Transform at(double time) const override;
  bool rests() const override;
  double turn_rate(const TimeSpan& during) const override;
  const Vec3& velocity() const { return velocity_; }
  const Vec3& angular_velocity() const { return angular_velocity_; }

 private:
  Vec3 velocity_, angular_velocity_;
};

// Interpolates translations [T] in m and unit quaternions [T] given at ascending times [T] in s, T >= 2. kCubic uses C2
// cubic splines (spline.h) through the translations and the sign-continuous quaternions (then normalised); kLinear is
// piecewise linear with slerp; kMonotone uses C1 cubics that do not swing past keys. Both latter have a breakpoint at each
// inner time. As q and -q are one rotation, it turns the shorter way between keys, so neighbours should be less than 180
// degrees apart.
class KeyframeMotion : public Motion {
 public:
  // Empty translations mean zero, empty rotations mean identity; not both may be empty. Rotations may be off unit length by
  // 1e-6. Raises invalid_argument otherwise.
  KeyframeMotion(std::vector<double> times, std::vector<Vec3> translations, std::vector<Quaternion> rotations,
                 Interpolation interpolation = Interpolation::kCubic);
  Transform at(double time) const override;
  std::vector<double> breakpoints(const TimeSpan& during = {}) const override;
  bool rests() const override;  // all keys are equal
  TimeSpan span() const override;
  double turn_rate(const TimeSpan& during) const override;
  const std::vector<double>& times() const;
  const std::vector<Vec3>& translations() const;
  const std::vector<Quaternion>& rotations() const;
  Interpolation interpolation() const;

 private:
  struct Data;
  std::shared_ptr<const Data> data_;
};

// Returns whether a motion moves anything. A null one does not.
inline bool moves(const std::shared_ptr<const Motion>& motion) { return motion && !motion->rests(); }

// Returns parent_from_node(t) = Translation(placement) * motion(t) * Linear(placement). By this one rule motions move what
// is placed: it turns about its own origin, in the axes of its parent. A null `motion` means at rest.
Transform moved(const Transform& placement, const Motion* motion, double time);

}  // namespace echopath
