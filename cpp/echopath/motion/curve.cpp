#include "echopath/motion/curve.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "echopath/base/errors.h"

namespace echopath {
namespace {

constexpr double kShortestPeriod = 1e-6;  // s: shorter than any chirp
constexpr double kLongestTime = 1e9;      // s: beyond it sums of times are too coarse
constexpr int64_t kMostRuns = 100000;     // of a loop within one span, so that lists of times end
constexpr int kSamplesPerPiece = 4;       // among which the turning points of a Hermite spline are found

void check_numbers(const std::vector<double>& numbers, size_t count, std::string_view argument, const std::string& what) {
  require(numbers.size() == count, argument, "must have a row of " + what + " for each time; numbers", numbers.size());
  const std::string rule = "must have finite " + what;
  for (const double number : numbers) require(std::isfinite(number), argument, rule, number);
}

bool is_limited(const TimeSpan& during) {
  const TimeSpan whole;
  return during.begin > whole.begin && during.end < whole.end;
}

// Returns the first and the last of the runs that `during` touches.
std::array<int64_t, 2> runs_in(const Playback& playback, const TimeSpan& during) {
  if (playback.period == 0.0 || !is_limited(during)) return {0, 0};
  const int64_t first = playback.run_at(during.begin);
  return {first, std::min(playback.run_at(during.end), first + kMostRuns)};
}

// Returns the times, ascending, at which the runs in `during` are looked at: the keys around it, and some between those of
// splines.
std::vector<double> sample_times(const Curve& curve, const Playback& playback, const TimeSpan& during) {
  constexpr int64_t kRunsThatTell = 2;  // the others repeat them
  const auto [first, last] = runs_in(playback, during);
  const int samples = curve.interpolation == CurveInterpolation::kHermite ? kSamplesPerPiece : 1;
  const auto [begin, end] = keys_played(curve, playback, during);
  // A key is to spare on either side.
  const size_t from = begin > 0 ? begin - 1 : 0, to = std::min(end + 2, curve.times.size());
  std::vector<double> times;
  for (int64_t run = first; run <= std::min(last, first + kRunsThatTell); ++run) {
    for (size_t k = from; k < to; ++k) {
      const double step = k + 1 < curve.times.size() ? curve.times[k + 1] - curve.times[k] : 0.0;
      for (int i = 0; i < samples; ++i) times.push_back(playback.time_of(curve.times[k] + step * i / samples, run));
    }
  }
  std::ranges::sort(times);
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

}  // namespace

void Curve::validate_times(const char* argument) const {
  require(!times.empty(), argument, "must hold at least one time", 0);
  for (size_t i = 0; i < times.size(); ++i) {
    require(std::isfinite(times[i]) && std::abs(times[i]) <= kLongestTime, argument, "must have times of at most 1e9 s",
            times[i]);
    if (i > 0) require(times[i] > times[i - 1], argument, "must have strictly ascending times", times[i]);
  }
}

void Curve::validate(const char* argument, size_t num_columns) const {
  validate_times(argument);
  const size_t count = times.size() * num_columns;
  check_numbers(values, count, argument, "values");
  const bool has_tangents = interpolation == CurveInterpolation::kHermite;
  check_numbers(in_tangents, has_tangents ? count : 0, argument, "in_tangents");
  check_numbers(out_tangents, has_tangents ? count : 0, argument, "out_tangents");
}

bool Curve::is_constant() const {
  const auto is_zero = [](double tangent) { return tangent == 0.0; };
  const auto behind_first = values.begin() + static_cast<ptrdiff_t>(num_columns());
  return std::equal(behind_first, values.end(), values.begin()) && std::ranges::all_of(in_tangents, is_zero) &&
         std::ranges::all_of(out_tangents, is_zero);
}

void Playback::validate() const {
  require(std::isfinite(offset) && std::abs(offset) <= kLongestTime, "offset", "must be at most 1e9 s", offset);
  require(period == 0.0 || (period >= kShortestPeriod && period <= kLongestTime), "period", "must be 1e-6 to 1e9 s, or none",
          period);
}

// The quotient may round to the neighbouring run, whose ends decide.
int64_t Playback::run_at(double time) const {
  if (period == 0.0) return 0;
  require(std::abs(time) <= kLongestTime, "time", "must be at most 1e9 s for a loop", time);
  auto run = static_cast<int64_t>(std::floor((time + offset) / period));
  while (time < time_of(0.0, run)) --run;
  while (time >= time_of(0.0, run + 1)) ++run;
  return run;
}

double Playback::time_of(double key_time, int64_t run) const {
  return (static_cast<double>(run) * period - offset) + key_time;
}

void Playback::append_times(const std::vector<double>& key_times, const TimeSpan& during, std::vector<double>& out) const {
  if (key_times.size() < 2) return;  // it never changes
  const auto [first, last] = runs_in(*this, during);
  const auto add = [&](double time) {
    if (time >= during.begin && time <= during.end) out.push_back(time);
  };
  for (int64_t run = first; run <= last; ++run) {
    if (period > 0.0) add(time_of(0.0, run));
    for (const double key : key_times) {
      if (period == 0.0 || (key > 0.0 && key < period)) add(time_of(key, run));
    }
  }
}

CurvePlace place_on(const Curve& curve, const Playback& playback, double time) {
  require(std::isfinite(time), "time", "must be finite", time);
  const int64_t run = playback.run_at(time);
  const auto after = std::partition_point(curve.times.begin(), curve.times.end(),
                                          [&](double key) { return playback.time_of(key, run) <= time; });
  const auto next = static_cast<size_t>(after - curve.times.begin());
  if (next == 0) return {};
  if (next == curve.times.size()) return {next - 1, next - 1, 0.0};
  const double begin = playback.time_of(curve.times[next - 1], run), step = curve.times[next] - curve.times[next - 1];
  return {next - 1, next, std::clamp((time - begin) / step, 0.0, 1.0)};
}

KnotRange keys_played(const Curve& curve, const Playback& playback, const TimeSpan& during) {
  const size_t last = curve.times.size() - 1;
  if (last == 0) return {};
  if (playback.period > 0.0) return {0, last};
  return knots_around(curve.times, {during.begin + playback.offset, during.end + playback.offset});
}

double time_at_rest(double time) {
  require(std::isfinite(time), "time", "must be finite", time);
  return 0.0;
}

std::array<double, 4> curve_weights(const Curve& curve, const CurvePlace& place) {
  const double s = place.s;
  if (place.k == place.next || curve.interpolation == CurveInterpolation::kStep) return {1.0, 0.0, 0.0, 0.0};
  if (curve.interpolation == CurveInterpolation::kLinear) return {1.0 - s, 0.0, s, 0.0};
  const double step = curve.times[place.next] - curve.times[place.k], rest = 1.0 - s;
  return {(1.0 + 2.0 * s) * rest * rest, step * s * rest * rest, s * s * (3.0 - 2.0 * s), -step * s * s * rest};
}

void evaluate(const Curve& curve, const Playback& playback, double time, std::span<double> out) {
  const CurvePlace place = place_on(curve, playback, time);
  const std::array<double, 4> weights = curve_weights(curve, place);
  const size_t width = out.size(), here = place.k * width, there = place.next * width;
  for (size_t c = 0; c < width; ++c) {
    out[c] = weights[0] * curve.values[here + c] + weights[2] * curve.values[there + c];
    if (curve.in_tangents.empty()) continue;
    out[c] += weights[1] * curve.out_tangents[here + c] + weights[3] * curve.in_tangents[there + c];
  }
}

double curve_turn_rate(const Curve& curve, const Playback& playback, const TimeSpan& during,
                       const std::vector<double>& extents) {
  const std::vector<double> times = sample_times(curve, playback, during);
  if (times.size() < 2) return 0.0;
  const auto [first, last] = knots_around(times, during);
  const size_t width = curve.num_columns();
  std::vector<double> row(width);
  std::vector<TurningPoints> turns((width + 2) / 3);
  for (size_t i = first; i <= last; ++i) {
    evaluate(curve, playback, times[i], row);
    for (size_t c = 0; c < width && c < extents.size(); ++c) row[c] *= extents[c];
    for (size_t c = 0; c < width; c += 3) {
      turns[c / 3].add(times[i], {row[c], c + 1 < width ? row[c + 1] : 0.0, c + 2 < width ? row[c + 2] : 0.0});
    }
  }
  double rate = 0.0;
  for (const TurningPoints& each : turns) rate = std::max(rate, each.rate());
  return rate;
}

}  // namespace echopath
