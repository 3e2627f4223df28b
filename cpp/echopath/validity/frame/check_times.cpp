#include "echopath/validity/frame/check_times.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "echopath/base/constants.h"
#include "echopath/replay/time/turn_rates.h"

namespace echopath {
namespace {

constexpr double kSmallTurn = 0.25 * kPi;  // rad: what turns no farther is followed by the base
constexpr double kChecksPerBreakpoint = 2.0;

// Counts the breakpoints of a motion, of which there may be none, inside the frame.
template <class Moves>
int64_t breakpoints_within(const std::shared_ptr<const Moves>& motion, const TimeSpan& frame) {
  if (!motion) return 0;
  return std::ranges::count_if(motion->breakpoints(frame),
                               [&](double time) { return time > frame.begin && time < frame.end; });
}

// Counts the breakpoints of the motions of a mesh and of those above it.
int64_t breakpoints_within(const Scene& scene, uint32_t mesh_id, const TimeSpan& frame) {
  int64_t count = breakpoints_within(scene.node_of(mesh_id).deformation, frame);
  for (int i = scene.meshes()[mesh_id].node; i >= 0; i = scene.nodes()[i].parent)
    count += breakpoints_within(scene.nodes()[i].motion, frame);
  return count;
}

std::vector<double> turns_of(const Scene& scene, double turn_of_radar, const TimeSpan& frame) {
  std::vector<double> turns;
  for (uint32_t id = 0; id < scene.meshes().size(); ++id)
    turns.push_back(turn_rate(scene, id, frame) * (frame.end - frame.begin) + turn_of_radar);
  return turns;
}

double turn_of(const Radar& radar, const TimeSpan& frame) { return turn_rate(radar, frame) * (frame.end - frame.begin); }

// Returns how many times beyond the base are due for so many breakpoints and so far a turn (rad).
double further_times(int64_t num_breakpoints, double turn) {
  const double at_breakpoints = kChecksPerBreakpoint * static_cast<double>(num_breakpoints);
  return turn > kSmallTurn ? at_breakpoints + std::ceil(kChecksPerTurn * turn / kTwoPi) : at_breakpoints;
}

bool are_too_many(double further) { return kBaseCheckTimes + further > kMaxCheckTimes; }

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
  found.turn_of_radar = turn_of(radar, frame);
  found.turn = turns_of(scene, found.turn_of_radar, frame);
  found.num_base = kBaseCheckTimes;
  const int64_t of_radar = breakpoints_within(radar.motion, frame);
  found.is_radar_too_fast = are_too_many(further_times(of_radar, found.turn_of_radar));
  int most = kBaseCheckTimes;
  for (uint32_t id = 0; id < found.turn.size(); ++id) {
    const double more = further_times(of_radar + breakpoints_within(scene, id, frame), found.turn[id]);
    if (are_too_many(more)) found.too_fast.push_back(id);
    found.of_mesh.push_back(static_cast<int>(std::min<double>(kBaseCheckTimes + more, kMaxCheckTimes)));
    most = std::max(most, found.of_mesh.back());
  }
  found.times = golden_times(frame, most);
  return found;
}

CheckTimes given_check_times(const Scene& scene, const Radar& radar, double start, std::vector<double> times) {
  CheckTimes found;
  const TimeSpan frame = frame_of(radar, start);
  found.turn_of_radar = turn_of(radar, frame);
  found.turn = turns_of(scene, found.turn_of_radar, frame);
  found.num_base = static_cast<int>(times.size());
  found.of_mesh.assign(scene.meshes().size(), found.num_base);
  found.times = std::move(times);
  return found;
}

}  // namespace echopath
