#include "echopath/motion/spline.h"

#include <cmath>
#include <utility>

#include "echopath/base/constants.h"
#include "echopath/base/errors.h"
#include "echopath/base/text/streamed.h"
#include "echopath/base/threads/parallel.h"

namespace echopath {
namespace {

constexpr double kTimeRounding = 1e-12;    // relative, and in s for times below 1 s
constexpr double kMinDisplacement = 1e-9;  // m
constexpr double kLongEnd = 8.0;           // times the piece next to it
constexpr int64_t kPointsPerTask = 680;    // keeps three rows of their coordinates in the first-level cache

using Velocity = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 4, 1>;  // of a point with up to 4 coordinates, per s

void check_times(const std::vector<double>& times) {
  require(times.size() >= 2, "times", "must hold at least 2 times", times.size());
  for (size_t i = 0; i < times.size(); ++i) {
    require(std::isfinite(times[i]), "times", "must be finite", times[i]);
    if (i > 0) require(times[i] > times[i - 1], "times", "must be strictly ascending", times[i]);
  }
}

// Returns the velocity at a knot of kMonotone, of those before and behind it, on for `step_before` and `step_after`, s.
Velocity velocity_between(const Velocity& before, const Velocity& after, double step_before, double step_after) {
  const double speed_before = before.norm(), speed_after = after.norm();
  if (!(speed_before > 0.0 && speed_after > 0.0)) return Velocity::Zero(before.size());
  const double weight_before = step_before + 2.0 * step_after, weight_after = 2.0 * step_before + step_after;
  const double speed = (weight_before + weight_after) / (weight_before / speed_before + weight_after / speed_after);
  return 0.5 * speed * (before / speed_before + after / speed_after);
}

// Returns the velocity at an end of kMonotone, of that in the outermost step and that in the next: that of the parabola
// through three knots, which neither turns back nor, where the next step does, is more than 3 times as fast as the outermost
// one (C. Moler, "Numerical Computing with MATLAB", 2004, ch. 3.4).
Velocity velocity_at_end(const Velocity& outer, const Velocity& next, double outer_step, double next_step) {
  const Velocity velocity = outer + outer_step / (outer_step + next_step) * (outer - next);
  if (!(velocity.dot(outer) > 0.0)) return Velocity::Zero(outer.size());
  const double most = 3.0 * outer.norm(), speed = velocity.norm();
  return outer.dot(next) <= 0.0 && speed > most ? Velocity(velocity * (most / speed)) : velocity;
}

}  // namespace

double rounding_of(double begin, double end) { return kTimeRounding * std::max({1.0, std::abs(begin), std::abs(end)}); }

double time_inside(double time, const TimeSpan& span) {
  const double slack = rounding_of(span.begin, span.end);
  if (!(time >= span.begin - slack && time <= span.end + slack)) {
    const std::string limits = with_digits(17, span.begin) + ", " + with_digits(17, span.end);
    require(false, "time", "must lie in the motion's [" + limits + "] s", time);
  }
  return std::clamp(time, span.begin, span.end);
}

KnotRange knots_around(const std::vector<double>& times, const TimeSpan& during) {
  const auto after_begin = std::upper_bound(times.begin() + 1, times.end() - 1, during.begin);
  const auto from_end = std::lower_bound(after_begin, times.end() - 1, during.end);
  return {static_cast<size_t>(after_begin - times.begin()) - 1, static_cast<size_t>(from_end - times.begin())};
}

void TurningPoints::add(double time, const Vec3& position) {
  for (int i = 0; i < 3; ++i) {
    if (is_empty_) axes_[i] = {position[i], time};
    else add(time, position[i], axes_[i]);
  }
  is_empty_ = false;
}

// The extreme moves on while the position does; a displacement back by more than rounding makes it a turning point.
void TurningPoints::add(double time, double value, Axis& axis) {
  const double displacement = value - axis.extreme;
  if (axis.direction != 0 && displacement * axis.direction >= 0.0) {
    axis.extreme = value, axis.time = time;
    return;
  }
  if (std::abs(displacement) <= kMinDisplacement) return;
  if (axis.direction != 0) {
    if (axis.has_turned) rate_ = std::max(rate_, kPi / (axis.time - axis.last_turn));
    axis.has_turned = true;
    axis.last_turn = axis.time;
  }
  axis.direction = displacement > 0.0 ? 1 : -1;
  axis.extreme = value, axis.time = time;
}

SplineKnots::SplineKnots(std::vector<double> times, Interpolation interpolation)
    : times_(std::move(times)), interpolation_(interpolation) {
  check_times(times_);
  for (size_t i = 0; i + 1 < times_.size(); ++i) step_.push_back(times_[i + 1] - times_[i]);
  if (interpolation == Interpolation::kCubic && has_derivatives()) factor();
}

std::vector<double> SplineKnots::breakpoints() const {
  if (interpolation_ == Interpolation::kCubic) return {};
  return {times_.begin() + 1, times_.end() - 1};
}

double SplineKnots::end_share(size_t end_piece, size_t next_piece) const {
  const double ratio = step_[end_piece] / step_[next_piece];
  return ratio <= kLongEnd ? ratio : 0.0;
}

// Row i: h[i-1] m[i-1] + 2 (h[i-1] + h[i]) m[i] + h[i] m[i+1] = 6 (slope[i] - slope[i-1]). The ends m[0] and m[T-1] are
// eliminated by a continuous third derivative at knots 1 and T-2, or in long end pieces by none; the matrix stays diagonally
// dominant.
void SplineKnots::factor() {
  const size_t n = times_.size();
  const std::vector<double>& h = step_;
  lower_.assign(n, 0.0), inverse_.assign(n, 0.0), upper_.assign(n, 0.0);
  std::vector<double> diagonal(n, 0.0);
  for (size_t i = 1; i + 1 < n; ++i) {
    lower_[i] = h[i - 1], diagonal[i] = 2.0 * (h[i - 1] + h[i]), upper_[i] = h[i];
  }
  if (n == 3) {  // one parabola: all second derivatives are equal
    inverse_[1] = 1.0 / (3.0 * (h[0] + h[1]));
    return;
  }
  const double first = end_share(0, 1), last = end_share(n - 2, n - 3);
  diagonal[1] += h[0] * (1.0 + first), upper_[1] -= h[0] * first;
  diagonal[n - 2] += h[n - 2] * (1.0 + last), lower_[n - 2] -= h[n - 2] * last;
  lower_[1] = 0.0, upper_[n - 2] = 0.0;
  for (size_t i = 1; i + 1 < n; ++i) {
    inverse_[i] = 1.0 / (diagonal[i] - lower_[i] * upper_[i - 1]);
    upper_[i] *= inverse_[i];
  }
}

void SplineKnots::derivatives(const std::vector<const double*>& rows, int64_t num_points, int64_t num_axes,
                              const std::vector<double*>& out) const {
  const auto work = [&](int64_t begin, int64_t end) {
    if (interpolation_ == Interpolation::kMonotone) velocities_of_points(rows, num_axes, out, begin, end);
    else solve_columns(rows, out, num_axes * begin, num_axes * end);
  };
  if (num_points <= kPointsPerTask) return work(0, num_points);
  parallel_for_chunks(num_points, kPointsPerTask, work);
}

void SplineKnots::velocities_of_points(const std::vector<const double*>& rows, int64_t num_axes,
                                       const std::vector<double*>& out, int64_t begin, int64_t end) const {
  const size_t last = times_.size() - 1;
  for (int64_t point = begin; point < end; ++point) {
    const int64_t first_column = num_axes * point;
    const auto velocity = [&](size_t k) -> Velocity {
      const Eigen::Map<const Velocity> from(rows[k] + first_column, num_axes), to(rows[k + 1] + first_column, num_axes);
      return (to - from) / step_[k];
    };
    const auto derivative = [&](size_t k) { return Eigen::Map<Velocity>(out[k] + first_column, num_axes); };
    Velocity before = velocity(0);
    derivative(0) = velocity_at_end(before, velocity(1), step_[0], step_[1]);
    for (size_t k = 1; k < last; ++k) {
      const Velocity after = velocity(k);
      derivative(k) = velocity_between(before, after, step_[k - 1], step_[k]);
      before = after;
    }
    derivative(last) = velocity_at_end(before, velocity(last - 2), step_[last - 1], step_[last - 2]);
  }
}

void SplineKnots::solve_columns(const std::vector<const double*>& rows, const std::vector<double*>& out, int64_t begin,
                                int64_t end) const {
  const size_t n = times_.size();
  const std::vector<double>& h = step_;
  for (size_t i = 1; i + 1 < n; ++i) {
    const double *before = rows[i - 1], *here = rows[i], *after = rows[i + 1];
    const double* previous = i > 1 ? out[i - 1] : here;  // its factor lower_[1] is 0
    for (int64_t c = begin; c < end; ++c) {
      const double right_side = 6.0 * ((after[c] - here[c]) / h[i] - (here[c] - before[c]) / h[i - 1]);
      const double known = i > 1 ? lower_[i] * previous[c] : 0.0;
      out[i][c] = (right_side - known) * inverse_[i];
    }
  }
  if (n == 3) {
    for (int64_t c = begin; c < end; ++c) out[0][c] = out[2][c] = out[1][c];
    return;
  }
  for (size_t i = n - 3; i >= 1; --i) {
    for (int64_t c = begin; c < end; ++c) out[i][c] -= upper_[i] * out[i + 1][c];
  }
  const double first = end_share(0, 1), last = end_share(n - 2, n - 3);
  for (int64_t c = begin; c < end; ++c) {
    out[0][c] = (1.0 + first) * out[1][c] - first * out[2][c];
    out[n - 1][c] = (1.0 + last) * out[n - 2][c] - last * out[n - 3][c];
  }
}

SplineKnots::Weights SplineKnots::weights(double time, bool at_rest) const {
  time = time_inside(time, span());
  if (at_rest) time = times_.front();
  const auto after = std::upper_bound(times_.begin() + 1, times_.end() - 1, time);
  const auto k = static_cast<size_t>(after - times_.begin()) - 1;
  const double h = step_[k];
  const double b = (time - times_[k]) / h, a = (times_[k + 1] - time) / h;
  if (!has_derivatives()) return {k, {a, b}, {0.0, 0.0}};
  if (interpolation_ == Interpolation::kCubic)
    return {k, {a, b}, {(a * a - 1.0) * a * h * h / 6.0, (b * b - 1.0) * b * h * h / 6.0}};
  return {k, {(1.0 + 2.0 * b) * a * a, (1.0 + 2.0 * a) * b * b}, {b * a * a * h, -a * b * b * h}};
}

}  // namespace echopath
