#include "echopath/motion/looped_sequence.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "echopath/base/errors.h"
#include "echopath/motion/spline.h"

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

// A vertex may turn where one run ends and the next begins, so several of them are looked at, one behind the other.
double LoopedSequence::turn_rate(const TimeSpan&) const {
  constexpr int kRunsThatTell = 3;  // the others repeat them
  double fastest = VertexSequence::turn_rate(VertexSequence::span());
  for (size_t vertex = 0; vertex < vertices().front().size(); ++vertex) {
    TurningPoints turns;
    for (int run = 0; run < kRunsThatTell; ++run) {
      for (size_t k = 0; k < times().size(); ++k) {
        const bool is_played = times()[k] >= 0.0 && times()[k] < playback_.period;
        if (is_played) turns.add(run * playback_.period + times()[k], vertices()[k][vertex]);
      }
    }
    fastest = std::max(fastest, turns.rate());
  }
  return fastest;
}

std::vector<double> LoopedSequence::knots(const TimeSpan& during) const {
  return ascending_times(playback_, times(), during);
}

}  // namespace echopath
