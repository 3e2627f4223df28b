#pragma once
// Defines a vertex sequence that repeats itself with a period.
#include "echopath/motion/curve.h"
#include "echopath/motion/deformation.h"

namespace echopath {

// Plays the part [0, period) of its own times over and over, as `playback` shows it, and so is defined at every time.
// Frames before 0 and behind the period shape the ends of that part: with those of the runs around it a closed loop goes on
// smoothly. Breakpoints are those of the sequence and the ends of runs. Immutable.
class LoopedSequence : public VertexSequence {
 public:
  // Raises invalid_argument naming the argument: playback must have a period, and `times` must reach from 0 s to it.
  LoopedSequence(std::vector<double> times, std::vector<std::vector<Vec3>> vertices, Interpolation interpolation,
                 const Playback& playback);
  std::vector<Vec3> at(double time) const override;
  void at(double time, const std::vector<uint32_t>& indices, std::vector<Vec3>& out) const override;
  std::vector<double> breakpoints(const TimeSpan& during = {}) const override;
  TimeSpan span() const override { return {}; }
  double turn_rate(const TimeSpan& during) const override;
  // Returns the times of the scene, within `during`, of its frames and of the ends of runs.
  std::vector<double> knots(const TimeSpan& during) const;
  const Playback& playback() const { return playback_; }

 private:
  double own_time(double time) const;
  Playback playback_;
};

}  // namespace echopath
