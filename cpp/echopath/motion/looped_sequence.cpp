#include "echopath/motion/looped_sequence.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "echopath/base/errors.h"

namespace echopath {
namespace {

std::vector<double> ascending_times(const Playback& playback, const std::vector<double>& own, const TimeSpan& during) {
  std::vector<double> times;
  playback.append_times(own, during, times);
  std::ranges::sort(times);
  return times;
}

}  // namespace

LoopedSequence::LoopedSequence(std::vector<double> times, std::vector<std::vector<Vec3>> vertices,
                               Interpolation interpolation, const Playback& playback)
    : VertexSequence(std::move(times), std::move(vertices), interpolation), playback_(playback) {
  playback.validate();
  require(playback.period > 0.0, "period", "must be above 0 s", playback.period);
  const TimeSpan whole = VertexSequence::span();
  require(whole.begin <= 0.0, "times", "must begin at 0 s or before, where there is a period; begin", whole.begin);
  require(whole.end >= playback.period, "times", "must reach to the period; end", whole.end);
}

double LoopedSequence::own_time(double time) const {
  require(std::isfinite(time), "time", "must be finite", time);
  return std::clamp(time - playback_.time_of(0.0, playback_.run_at(time)), 0.0, playback_.period);
}

std::vector<Vec3> LoopedSequence::at(double time) const { return VertexSequence::at(own_time(time)); }

void LoopedSequence::at(double time, const std::vector<uint32_t>& indices, std::vector<Vec3>& out) const {
  VertexSequence::at(own_time(time), indices, out);
}

std::vector<double> LoopedSequence::breakpoints(const TimeSpan& during) const {
  std::vector<double> own = VertexSequence::breakpoints({});
  own.insert(own.begin(), VertexSequence::span().begin);
  own.push_back(VertexSequence::span().end);
  return ascending_times(playback_, own, during);
}

double LoopedSequence::turn_rate(const TimeSpan&) const { return VertexSequence::turn_rate(VertexSequence::span()); }

std::vector<double> LoopedSequence::knots(const TimeSpan& during) const {
  return ascending_times(playback_, times(), during);
}

}  // namespace echopath
