#include "echopath/motion/spline.h"

#include <algorithm>
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
constexpr int64_t kColumnsPerTask = 2048;  // keeps three rows of a block in the first-level cache

void check_times(const std::vector<double>& times) {
  require(times.size() >= 2, "times", "must hold at least 2 times", times.size());
  for (size_t i = 0; i < times.size(); ++i) {
    require(std::isfinite(times[i]), "times", "must be finite", times[i]);
    if (i > 0) require(times[i] > times[i - 1], "times", "must be strictly ascending", times[i]);
  }
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
  if (has_curvature()) factor();
}

std::vector<double> SplineKnots::breakpoints() const {
  if (interpolation_ == Interpolation::kCubic) return {};
  return {times_.begin() + 1, times_.end() - 1};
}

// Row i: h[i-1] m[i-1] + 2 (h[i-1] + h[i]) m[i] + h[i] m[i+1] = 6 (slope[i] - slope[i-1]). The ends m[0] and m[T-1] are
// eliminated by a continuous third derivative at knots 1 and T-2; the matrix stays diagonally dominant.
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
  diagonal[1] += h[0] * (1.0 + h[0] / h[1]), upper_[1] -= h[0] * h[0] / h[1];
  diagonal[n - 2] += h[n - 2] * (1.0 + h[n - 2] / h[n - 3]), lower_[n - 2] -= h[n - 2] * h[n - 2] / h[n - 3];
  lower_[1] = 0.0, upper_[n - 2] = 0.0;
  for (size_t i = 1; i + 1 < n; ++i) {
    inverse_[i] = 1.0 / (diagonal[i] - lower_[i] * upper_[i - 1]);
    upper_[i] *= inverse_[i];
  }
}

void SplineKnots::second_derivatives(const std::vector<const double*>& rows, int64_t width,
                                     const std::vector<double*>& out) const {
  if (width <= kColumnsPerTask) return solve_columns(rows, out, 0, width);
  parallel_for_chunks(width, kColumnsPerTask, [&](int64_t begin, int64_t end) { solve_columns(rows, out, begin, end); });
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
  const double first = h[0] / h[1], last = h[n - 2] / h[n - 3];
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
  Weights weights{k, {a, b}, {0.0, 0.0}};
  if (has_curvature()) {
    weights.curvature[0] = (a * a - 1.0) * a * h * h / 6.0;
    weights.curvature[1] = (b * b - 1.0) * b * h * h / 6.0;
  }
  return weights;
}

}  // namespace echopath
