#pragma once
// Interpolates over knot times, for everything that is sampled: positions, quaternions, vertices.
#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

#include "echopath/motion/motion.h"

namespace echopath {

// Holds knot times and the factors of the spline equations, made once and used for any number of columns. Immutable.
//
// kCubic is the C2 cubic spline with not-a-knot ends (de Boor, "A Practical Guide to Splines", ch. IV): the first two
// and the last two pieces are one cubic each, so every cubic is reproduced. Two knots give the line, three the
// parabola. An end piece more than eight times as long as its neighbour is a parabola: as part of the same cubic it
// would swing by what the neighbour bends times the cube of their ratio.
//
// kMonotone has cubic pieces whose speed at a knot is the weighted harmonic mean of the speeds of the straight ways before
// and behind (F. N. Fritsch, J. Butland, SIAM J. Sci. Stat. Comput. 5, 1984, p. 300), and whose direction is the mean of
// their unit vectors, which shortens it where the way bends: what rests between two knots stays there, what turns back
// does so at the knot, and points on a line never pass their knots. Turned samples give the turned curve.
class SplineKnots {
 public:
  // `times` [T] in s. Raises invalid_argument naming `times` unless there are at least 2, finite and strictly ascending.
  SplineKnots(std::vector<double> times, Interpolation interpolation);

  const std::vector<double>& times() const { return times_; }
  Interpolation interpolation() const { return interpolation_; }
  TimeSpan span() const { return {times_.front(), times_.back()}; }
  std::vector<double> breakpoints() const;  // inner knots, unless the interpolation is C2

  // The value at a time is value[0] y[k] + value[1] y[k+1] + derivative[0] d[k] + derivative[1] d[k+1], with the samples
  // y and their derivatives d of `derivatives`, whose weights are 0 where `has_derivatives` is false.
  struct Weights {
    size_t k;
    double value[2];
    double derivative[2];  // s^2 of kCubic, s of kMonotone
  };
  // Raises invalid_argument outside span(), but forgives rounding errors of the time. Samples at rest, which are all equal,
  // have the weights of the first knot at all times: between knots their sum would differ in its last bits.
  Weights weights(double time, bool at_rest) const;

  bool has_derivatives() const { return interpolation_ != Interpolation::kLinear && times_.size() > 2; }
  // Computes the second derivatives (per s^2) of kCubic, or the first ones (per s) of kMonotone, of the curves through
  // samples of `num_points` points with `num_axes` coordinates, at most 4: rows [T] point to num_points x num_axes numbers
  // each, and so do `out` [T]. Requires has_derivatives().
  void derivatives(const std::vector<const double*>& rows, int64_t num_points, int64_t num_axes,
                   const std::vector<double*>& out) const;

 private:
  void factor();
  // Returns by how much the second derivative at an end differs from that at the next knot, over how much that one differs
  // from that of the knot behind it.
  double end_share(size_t end_piece, size_t next_piece) const;
  void velocities_of_points(const std::vector<const double*>& rows, int64_t num_axes, const std::vector<double*>& out,
                            int64_t begin, int64_t end) const;
  void solve_columns(const std::vector<const double*>& rows, const std::vector<double*>& out, int64_t begin,
                     int64_t end) const;

  std::vector<double> times_;
  Interpolation interpolation_;
  std::vector<double> step_;                     // [T-1] s
  std::vector<double> lower_, inverse_, upper_;  // [T] rows 1..T-2 of the factored tridiagonal matrix
};

template <class Sample>
bool all_equal(const std::vector<Sample>& samples) {
  return std::ranges::adjacent_find(samples, std::ranges::not_equal_to()) == samples.end();
}

// Holds the indices of the knots between which a span of time lies, as far as there are knots.
struct KnotRange {
  size_t first = 0, last = 0;
};
KnotRange knots_around(const std::vector<double>& times, const TimeSpan& during);

// Finds the turning points of a sampled position. rate() is pi over the shortest time between two of them, rad/s, or 0 where
// there are fewer than two. Displacements of less than a nanometre are rounding.
class TurningPoints {
 public:
  void add(double time, const Vec3& position);
  double rate() const { return rate_; }

 private:
  struct Axis {
    double extreme = 0.0, time = 0.0;  // the farthest point in the direction of travel, m, s
    int direction = 0;
    double last_turn = 0.0;  // s
    bool has_turned = false;
  };
  void add(double time, double value, Axis& axis);

  Axis axes_[3];
  bool is_empty_ = true;
  double rate_ = 0.0;
};

// Returns the rounding, in s, of times between `begin` and `end` (s) that are sums of intervals: by so much may the last
// chirp pass the last key.
double rounding_of(double begin, double end);

// Returns `time` moved into `span`; raises invalid_argument unless it is inside up to rounding.
double time_inside(double time, const TimeSpan& span);

}  // namespace echopath
