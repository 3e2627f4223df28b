#include "echopath/spectrum/cfar/peaks.h"

#include <cmath>
#include <optional>

#include "echopath/base/errors.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/spectrum/array/tdm.h"
#include "echopath/spectrum/tone_offset.h"

namespace echopath {
namespace {

using Cell = std::array<int64_t, 2>;

class PeakFinder {
 public:
  PeakFinder(const RangeDoppler& map, const ChirpSequence& waveform, const std::vector<double>& power)
      : map_(map), power_(power), num_velocities_(std::ssize(map.velocity)), num_ranges_(std::ssize(map.range)),
        ranges_are_a_circle_(!waveform.real),
        velocity_(window_samples(map.window.velocity, waveform.num_chirps), map.zero_pad),
        range_(window_samples(map.window.range, waveform.num_samples), map.zero_pad) {}

  bool is_top(const Cell& cell) const {
    if (!tells_velocities() && cell[0] > 0) return false;  // all rows are the same, but for rounding
    const int64_t reach = tells_velocities() ? 1 : 0;
    for (int64_t v = -reach; v <= reach; ++v) {
      for (int64_t r = -1; r <= 1; ++r) {
        const auto other = index(cell[0] + v, cell[1] + r);
        const int64_t own = *index(cell[0], cell[1]);
        if (!other || *other == own) continue;
        if (power_[*other] > power_[own] || (power_[*other] == power_[own] && *other < own)) return false;
      }
    }
    return true;
  }

  double velocity_offset(const Cell& cell) const {
    return offset(velocity_, cell, index(cell[0] + 1, cell[1]), index(cell[0] - 1, cell[1]), num_velocities_);
  }
  bool tells_velocities() const { return !velocity_.is_flat(); }
  double range_offset(const Cell& cell) const {
    return offset(range_, cell, index(cell[0], cell[1] + 1), index(cell[0], cell[1] - 1), num_ranges_);
  }
  double power_in_cell(double velocity_offset, double range_offset) const {
    return velocity_.power(velocity_offset) * range_.power(range_offset);
  }

 private:
  // Returns the index in a channel's map; none beyond the ends of a range axis that does not wrap around.
  std::optional<int64_t> index(int64_t velocity, int64_t range) const {
    if (!ranges_are_a_circle_ && (range < 0 || range >= num_ranges_)) return {};
    return (velocity + num_velocities_) % num_velocities_ * num_ranges_ + (range + num_ranges_) % num_ranges_;
  }

  double offset(const ToneOffset& axis, const Cell& cell, std::optional<int64_t> above, std::optional<int64_t> below,
                int64_t num_cells) const {
    if (num_cells < 3 || !above || !below) return 0.0;
    const int64_t own = *index(cell[0], cell[1]), size = num_velocities_ * num_ranges_;
    const int channels = map_.num_transmitters * map_.num_receivers;
    double up = 0.0, down = 0.0;
    for (int c = 0; c < channels; ++c) {
      const std::complex<double>* field = map_.values.data() + c * size;
      up += (axis.phasor() * field[*above] * std::conj(field[own])).real();
      down += (std::conj(axis.phasor()) * field[*below] * std::conj(field[own])).real();
    }
    const double whole = power_[own] * channels;
    return axis.offset(up / whole, down / whole);
  }

  const RangeDoppler& map_;
  const std::vector<double>& power_;
  const int64_t num_velocities_, num_ranges_;
  const bool ranges_are_a_circle_;
  const ToneOffset velocity_, range_;
};

// Returns the value moved by whole spans into [first, first + span).
double folded(double value, double first, double span) { return value - span * std::floor((value - first) / span); }

}  // namespace

Peaks find_peaks(const RangeDoppler& map, const Radar& radar, const CfarResult& found, Job* job) {
  require_map_of(map, radar);
  require(found.power.size() == map.velocity.size() * map.range.size(), "found", "must be of the spectrum's cells",
          found.power.size());
  const PeakFinder finder(map, radar.waveform, found.power);
  Peaks peaks;
  for (size_t i = 0; i < found.cells.size(); ++i) {
    if (!finder.is_top(found.cells[i])) continue;
    peaks.cells.push_back(found.cells[i]);
    peaks.noise.push_back(found.noise[i]);
  }
  const int64_t count = std::ssize(peaks.cells);
  for (auto* values : {&peaks.velocity_offset, &peaks.range_offset, &peaks.velocity, &peaks.range, &peaks.power}) {
    values->resize(count);
  }
  const double span = 2.0 * radar.waveform.max_velocity(radar.num_slots());
  const double velocity_step = span / static_cast<double>(map.velocity.size());
  const double range_step = map.range.size() > 1 ? map.range[1] - map.range[0] : 0.0;
  parallel_for(count, [&](int64_t i) {
    if (job) job->throw_if_cancelled();
    const auto [v, r] = peaks.cells[i];
    const double up = peaks.velocity_offset[i] = finder.velocity_offset(peaks.cells[i]);
    const double away = peaks.range_offset[i] = finder.range_offset(peaks.cells[i]);
    const double shown = finder.tells_velocities() ? map.velocity[v] + up * velocity_step : 0.0;
    peaks.velocity[i] = folded(shown, map.velocity.front() - 0.5 * velocity_step, span);
    peaks.range[i] = map.range[r] + away * range_step;
    peaks.power[i] = found.power[v * std::ssize(map.range) + r] / finder.power_in_cell(up, away);
  });
  return peaks;
}

}  // namespace echopath
