#pragma once
// Evaluates curves through keys, as animation files have them, at the times at which they are played.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "echopath/motion/motion.h"
#include "echopath/motion/spline.h"

namespace echopath {

// Says how a curve goes from one key to the next (glTF 2.0, appendix C): it holds the earlier value and jumps at the later
// key (kStep), it is linear (kLinear), or it is a cubic Hermite spline with the tangents of the keys (kHermite).
enum class CurveInterpolation { kStep, kLinear, kHermite };

// Holds C numbers at each of T key times, T >= 1. Before its first key and behind its last key a curve keeps their values.
// It is immutable.
struct Curve {
  std::vector<double> times;   // [T] s, strictly ascending
  std::vector<double> values;  // [T, C]
  CurveInterpolation interpolation = CurveInterpolation::kLinear;
  std::vector<double> in_tangents = {}, out_tangents = {};  // [T, C] per s, before and behind each key; kHermite alone

  size_t num_columns() const { return times.empty() ? 0 : values.size() / times.size(); }
  bool is_constant() const;  // all keys are equal, and all tangents are 0
  // Raises invalid_argument naming `argument` unless the times ascend.
  void validate_times(const char* argument) const;
  // Raises the same, also unless the sizes fit `num_columns` and all numbers are finite.
  void validate(const char* argument, size_t num_columns) const;
};

// Tells which time of its curves a motion shows: at the time t of the scene it is t + offset, taken back into [0, period)
// where there is a period. Runs of a loop are counted, so that breakpoints and values agree to the bit on which side of a
// key a time lies.
struct Playback {
  double offset = 0.0;  // s
  double period = 0.0;  // s, 0: played once, and held before and after

  // Raises invalid_argument naming the argument.
  void validate() const;
  int64_t run_at(double time) const;                   // 0 where there is no period
  double time_of(double key_time, int64_t run) const;  // s, of the scene
  // Appends the times of the scene within `during` at which these keys and the ends of runs lie. An unlimited `during`
  // stands for run 0 alone. A single key never changes anything and has none.
  void append_times(const std::vector<double>& key_times, const TimeSpan& during, std::vector<double>& out) const;
};

// Says where a time lies among the keys of a curve: between the keys k and next, at the fraction s of the time between them.
// `next` is k + 1, or k beyond the ends of the curve.
struct CurvePlace {
  size_t k = 0, next = 0;
  double s = 0.0;
};
CurvePlace place_on(const Curve& curve, const Playback& playback, double time);
// Returns the one time, s, at which constant curves are read: between equal keys a sum differs in its last bits. Raises
// invalid_argument unless `time` (s) is finite.
double time_at_rest(double time);

// Returns the weights of value k, out-tangent k, value next and in-tangent next, by which a column has its value at the
// place: linear between keys, or Hermite. Tangents weigh 0 unless the curve has them.
std::array<double, 4> curve_weights(const Curve& curve, const CurvePlace& place);
// Writes the columns [C] at `time` (s, of the scene) to `out`.
void evaluate(const Curve& curve, const Playback& playback, double time, std::span<double> out);

// Returns the keys between which an unlooped curve is played; all of them where it is looped.
KnotRange keys_played(const Curve& curve, const Playback& playback, const TimeSpan& during);

// Returns pi over the shortest time between two turning points of any column within `during`, rad/s. Column c counts in
// metres as extents[c] times its value; beyond the columns of `extents` it counts as it is.
double curve_turn_rate(const Curve& curve, const Playback& playback, const TimeSpan& during,
                       const std::vector<double>& extents = {});

}  // namespace echopath
