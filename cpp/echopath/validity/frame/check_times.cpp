#include "echopath/validity/frame/check_times.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "echopath/base/constants.h"
#include "echopath/replay/time/turn_rates.h"

namespace echopath {
namespace {

constexpr double kSmallTurn = 0.25 * kPi;  // rad: what turns no farther is followed by the base
constexpr double kChecksPerBreakpoint = 2.0;

// Counts the breakpoints of the motions of a mesh, of those above it and of the radar.
int64_t breakpoints_within(const Scene& scene, const Radar& radar, uint32_t mesh_id, const TimeSpan& frame) {
  int64_t count = 0;
  const auto add = [&](const std::vector<double>& times) {
    count += std::ranges::count_if(times, [&](double time) { return time > frame.begin && time < frame.end; });
  };
  if (radar.motion) add(radar.motion->breakpoints(frame));
  if (const auto& deformation = scene.node_of(mesh_id).deformation) add(deformation->breakpoints(frame));
  for (int i = scene.meshes()[mesh_id].node; i >= 0; i = scene.nodes()[i].parent) {
    if (const auto& motion = scene.nodes()[i].motion) add(motion->breakpoints(frame));
  }
  return count;
}

std::vector<double> turns_of(const Scene& scene, const Radar& radar, const TimeSpan& frame) {
  const double of_radar = turn_rate(radar, frame);
  std::vector<double> turns;
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) {
    turns.push_back((turn_rate(scene, id, frame) + of_radar) * (frame.end - frame.begin));
  }
  return turns;
}

TimeSpan frame_of(const Radar& radar, double start) {
  const int last_tx = static_cast<int>(radar.transmitters.size()) - 1, last_chirp = radar.waveform.num_chirps - 1;
  return {start + radar.chirp_time(0, 0), start + radar.chirp_time(last_tx, last_chirp)};
}

std::vector<double> golden_times(const TimeSpan& frame, int count) {
  std::vector<double> times = {frame.begin, frame.end};
  for (int k = 1; k + 2 <= count; ++k) {
    const double turns = k * (std::numbers::phi - 1.0);
    times.push_back(frame.begin + (turns - std::floor(turns)) * (frame.end - frame.begin));
  }
  return times;
}

}  // namespace

CheckTimes check_times(const Scene& scene, const Radar& radar, double start) {
  const TimeSpan frame = frame_of(radar, start);
  const bool moves = radar.is_moving() || scene.is_anything_moving();
  if (frame.begin == frame.end || !moves) return given_check_times(scene, radar, start, {frame.begin});
  CheckTimes found;
  found.turn = turns_of(scene, radar, frame);
  found.num_base = kBaseCheckTimes;
  int most = kBaseCheckTimes;
  for (uint32_t id = 0; id < found.turn.size(); ++id) {
    double more = kChecksPerBreakpoint * static_cast<double>(breakpoints_within(scene, radar, id, frame));
    if (found.turn[id] > kSmallTurn) more += std::ceil(kChecksPerTurn * found.turn[id] / kTwoPi);
    if (kBaseCheckTimes + more > kMaxCheckTimes) found.too_fast.push_back(id);
    found.of_mesh.push_back(static_cast<int>(std::min<double>(kBaseCheckTimes + more, kMaxCheckTimes)));
    most = std::max(most, found.of_mesh.back());
  }
  found.times = golden_times(frame, most);
  return found;
}

CheckTimes given_check_times(const Scene& scene, const Radar& radar, double start, std::vector<double> times) {
  CheckTimes found;
  found.turn = turns_of(scene, radar, frame_of(radar, start));
  found.num_base = static_cast<int>(times.size());
  found.of_mesh.assign(scene.meshes().size(), found.num_base);
  found.times = std::move(times);
  return found;
}

}  // namespace echopath
