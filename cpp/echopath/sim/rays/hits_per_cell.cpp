#include "echopath/sim/rays/hits_per_cell.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "echopath/power/shared_phase.h"
#include "echopath/radar/noise_power.h"
#include "echopath/replay/replay.h"

namespace echopath {
namespace {

struct HitInCell {
  uint32_t group = 0;
  int64_t range = 0, velocity = 0;  // of the cell
  double power = 0.0;               // W

  auto cell() const { return std::tuple(group, range, velocity); }
};

// Returns the diffuse hits in the order of their cells. The paths over one hit in one cell are one.
std::vector<HitInCell> hits_in_cells(const Paths& paths, std::span<const uint32_t> group_of_path,
                                     std::span<const double> power_of_path, Job* job) {
  std::vector<int64_t> diffuse;
  for (int64_t path = 0; path < paths.num_paths(); ++path)
    if (paths.diffuse[path] != 0 && power_of_path[path] > 0.0) diffuse.push_back(path);
  const Radar radar = one_channel(paths.radar);
  const double quarter = 0.25 * radar.frame_duration();
  std::vector<double> before(diffuse.size()), after(diffuse.size());  // m
  if (!diffuse.empty()) {
    const Replayer::Moment moments[] = {{paths.frame.trace_time - quarter, before.data(), nullptr},
                                        {paths.frame.trace_time + quarter, after.data(), nullptr}};
    Replayer(paths, radar).evaluate(diffuse, moments, job);
  }
  const double of_range = 2.0 * radar.waveform.range_resolution();
  const double of_velocity = 2.0 * radar.waveform.velocity_resolution(paths.radar.num_slots()) * 2.0 * quarter;
  const auto cell_of = [](double length, double size) {  // a frame of one sample takes no time
    return size > 0.0 ? static_cast<int64_t>(std::floor(length / size)) : 0;
  };
  std::vector<HitInCell> hits;
  int64_t last = -1;
  for (size_t i = 0; i < diffuse.size(); ++i) {
    const int64_t path = diffuse[i];
    if (0.25 * (before[i] + after[i]) > radar.waveform.max_range()) continue;  // no cell holds it
    const HitInCell hit{group_of_path[path], cell_of(0.5 * (before[i] + after[i]), of_range),
                        cell_of(after[i] - before[i], of_velocity), power_of_path[path]};
    const bool is_known = last >= 0 && hits.back().cell() == hit.cell() && shares_phase(paths, path, last);
    if (is_known) {
      hits.back().power += hit.power;
    } else {
      hits.push_back(hit);
    }
    last = path;
  }
  std::ranges::stable_sort(hits, {}, &HitInCell::cell);
  return hits;
}

}  // namespace

std::vector<double> growth_by_cells(const Paths& paths, std::span<const uint32_t> group_of_path, size_t num_groups,
                                    std::span<const double> power_of_path, double most, Job* job) {
  const std::vector<HitInCell> hits = hits_in_cells(paths, group_of_path, power_of_path, job);
  const double noise =
      noise_power_in_cell(paths.radar) / static_cast<double>(paths.radar.transmitters.size() * paths.radar.receivers.size());
  std::vector<double> growth(num_groups, 0.0), weights(num_groups, 0.0);
  for (size_t i = 0; i < hits.size();) {
    const HitInCell& first = hits[i];
    double power = 0.0, squares = 0.0;
    for (; i < hits.size() && hits[i].cell() == first.cell(); ++i) {
      power += hits[i].power;
      squares += hits[i].power * hits[i].power;
    }
    const double of_a_hit = squares / power, weight = power / (noise + power);
    growth[first.group] += weight * std::min(kHitsPerCell * of_a_hit / (noise + power - of_a_hit), most);
    weights[first.group] += weight;
  }
  for (size_t group = 0; group < num_groups; ++group)
    if (weights[group] > 0.0) growth[group] /= weights[group];
  return growth;
}

}  // namespace echopath
