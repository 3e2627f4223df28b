#include "echopath/spectrum/cfar/peaks.h"

#include <cmath>
#include <complex>
#include <optional>

#include "echopath/base/errors.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/spectrum/array/element_reader.h"
#include "echopath/spectrum/array/steering.h"
#include "echopath/spectrum/array/tdm.h"
#include "echopath/spectrum/tone_offset.h"

namespace echopath {
namespace {

using Cell = std::array<int64_t, 2>;
using Fields = std::vector<std::complex<double>>;  // of all channels in one cell, or of one beam

// Finds the places of cells in the maps of channels. The axis of velocity is a circle, that of ranges for complex samples.
class CellPlaces {
 public:
  CellPlaces(const RangeDoppler& map, bool ranges_are_a_circle)
      : num_velocities_(std::ssize(map.velocity)), num_ranges_(std::ssize(map.range)),
        ranges_are_a_circle_(ranges_are_a_circle) {}

  int64_t num_velocities() const { return num_velocities_; }
  int64_t num_ranges() const { return num_ranges_; }
  int64_t num_cells() const { return num_velocities_ * num_ranges_; }
  // Returns the cell that these indices mean; none beyond the ends of an axis of ranges that is no circle.
  std::optional<Cell> cell(int64_t velocity, int64_t range) const {
    if (!ranges_are_a_circle_ && (range < 0 || range >= num_ranges_)) return {};
    return Cell{(velocity + num_velocities_) % num_velocities_, (range + num_ranges_) % num_ranges_};
  }
  int64_t place(const Cell& cell) const { return cell[0] * num_ranges_ + cell[1]; }

 private:
  const int64_t num_velocities_, num_ranges_;
  const bool ranges_are_a_circle_;
};

// Reads the channels of cells, and their power.
class ChannelReader {
 public:
  ChannelReader(const RangeDoppler& map, const Radar& radar, const CellPlaces& places, const CfarResult& found)
      : map_(map), places_(places), power_(found.power),
        taken_turns_(map.is_tdm_compensated ? carrier_turns(radar) : std::vector<double>()) {}

  Fields fields(int64_t, const Cell& cell, const Cell& other) const {
    Fields values(map_.num_transmitters * map_.num_receivers);
    for (size_t c = 0; c < values.size(); ++c)
      values[c] = map_.values[static_cast<int64_t>(c) * places_.num_cells() + places_.place(other)];
    if (taken_turns_.empty()) return values;
    // Phases of carriers were taken out by the range of each cell; the echo of one has that of its own in its neighbours.
    const double away = map_.range[other[1]] - map_.range[cell[1]];
    for (size_t c = 0; c < values.size(); ++c) values[c] *= std::polar(1.0, taken_turns_[c / map_.num_receivers] * away);
    return values;
  }
  double power(int64_t, const Cell&, const Cell& other) const { return power_[places_.place(other)]; }
  Fields beam_weights(int64_t, const Cell&) const { return {}; }

 private:
  const RangeDoppler& map_;
  const CellPlaces& places_;
  const std::vector<double>& power_;
  const std::vector<double> taken_turns_;  // [tx] rad/m, of carriers (tdm.h) that the map was compensated for; empty: none
};

// Reads the beam in which a cell was found, also in other cells.
class BeamReader {
 public:
  BeamReader(const RangeDoppler& map, const Radar& radar, const CellPlaces& places, const CfarResult& found)
      : map_(map), array_(virtual_array(radar)), reader_(map, array_, radar, Overlaps::kAverage, true), places_(places),
        directions_(found.beams) {}

  Fields fields(int64_t index, const Cell& cell, const Cell& other) const {
    Eigen::MatrixXcd values(reader_.num_elements(), 1);
    // The echo of the cell lies in its neighbours, too, with the phases between slots of its own velocity and range.
    const double turns = static_cast<double>(cell[0] - other[0]) / static_cast<double>(places_.num_velocities());
    reader_.read(other[0], other[1], 1, values, {turns, map_.range[cell[1]]});
    return {of_elements(index).cwiseProduct(values.col(0)).sum()};
  }
  double power(int64_t index, const Cell& cell, const Cell& other) const {
    return std::norm(fields(index, cell, other).front());
  }
  Fields beam_weights(int64_t index, const Cell& cell) const {
    const Eigen::VectorXcd weights = reader_.channel_weights(cell[0], cell[1], of_elements(index));
    return {weights.begin(), weights.end()};
  }

 private:
  Eigen::VectorXcd of_elements(int64_t index) const {
    return steering_vectors(array_, {directions_[index]}).col(0).conjugate() / static_cast<double>(reader_.num_elements());
  }

  const RangeDoppler& map_;
  const VirtualArray array_;
  const ElementReader reader_;
  const CellPlaces& places_;
  const std::vector<Vec3>& directions_;
};

// Finds the tops among the cells found, and where between the cells they lie.
template <class Reader>
class PeakFinder {
 public:
  PeakFinder(const RangeDoppler& map, const ChirpSequence& waveform, const CellPlaces& places, const Reader& reader,
             const std::vector<Cell>& cells)
      : places_(places), reader_(reader), cells_(cells),
        velocity_(window_samples(map.window.velocity, waveform.num_chirps), map.zero_pad),
        range_(window_samples(map.window.range, waveform.num_samples), map.zero_pad) {}

  bool is_top(int64_t index) const {
    const Cell& cell = cells_[index];
    if (!tells_velocities() && cell[0] > 0) return false;  // all rows are the same, but for rounding
    const int64_t reach = tells_velocities() ? 1 : 0;
    const double own = reader_.power(index, cell, cell);
    for (int64_t v = -reach; v <= reach; ++v) {
      for (int64_t r = -1; r <= 1; ++r) {
        const auto other = places_.cell(cell[0] + v, cell[1] + r);
        if (!other || *other == cell) continue;
        const double power = reader_.power(index, cell, *other);
        if (power > own || (power == own && *other < cell)) return false;
      }
    }
    return true;
  }

  double velocity_offset(int64_t index) const { return offset(velocity_, index, {1, 0}, places_.num_velocities()); }
  bool tells_velocities() const { return !velocity_.is_flat(); }
  double range_offset(int64_t index) const { return offset(range_, index, {0, 1}, places_.num_ranges()); }
  double power_in_cell(double velocity_offset, double range_offset) const {
    return velocity_.power(velocity_offset) * range_.power(range_offset);
  }

 private:
  double offset(const ToneOffset& axis, int64_t index, const Cell& step, int64_t num_cells) const {
    const Cell& cell = cells_[index];
    const auto above = places_.cell(cell[0] + step[0], cell[1] + step[1]);
    const auto below = places_.cell(cell[0] - step[0], cell[1] - step[1]);
    if (num_cells < 2 || !above || !below) return 0.0;
    const Fields own = reader_.fields(index, cell, cell);
    double whole = 0.0;
    for (const std::complex<double>& field : own) whole += std::norm(field);
    const double up = in_phase(axis.phasor(), reader_.fields(index, cell, *above), own);
    const double down = in_phase(std::conj(axis.phasor()), reader_.fields(index, cell, *below), own);
    return axis.offset(up / whole, down / whole);
  }

  static double in_phase(std::complex<double> phasor, const Fields& other, const Fields& own) {
    double sum = 0.0;
    for (size_t c = 0; c < own.size(); ++c) sum += (phasor * other[c] * std::conj(own[c])).real();
    return sum;
  }

  const CellPlaces& places_;
  const Reader& reader_;
  const std::vector<Cell>& cells_;
  const ToneOffset velocity_, range_;
};

// Returns the value moved by whole spans into [first, first + span).
double folded(double value, double first, double span) { return value - span * std::floor((value - first) / span); }

template <class Reader>
Peaks peaks_of(const RangeDoppler& map, const Radar& radar, const CfarResult& found, const CellPlaces& places,
               const Reader& reader, Job* job) {
  const PeakFinder finder(map, radar.waveform, places, reader, found.cells);
  std::vector<char> is_top(found.cells.size());
  parallel_for(std::ssize(is_top), [&](int64_t i) {
    if (job) job->throw_if_cancelled();
    is_top[i] = finder.is_top(i);
  });
  Peaks peaks;
  std::vector<int64_t> tops;
  for (int64_t i = 0; i < std::ssize(is_top); ++i) {
    if (!is_top[i]) continue;
    tops.push_back(i);
    peaks.cells.push_back(found.cells[i]);
    peaks.noise.push_back(found.noise[i]);
    const Fields weights = reader.beam_weights(i, found.cells[i]);
    peaks.beam_weights.insert(peaks.beam_weights.end(), weights.begin(), weights.end());
  }
  const int64_t count = std::ssize(tops);
  for (auto* values : {&peaks.velocity_offset, &peaks.range_offset, &peaks.velocity, &peaks.range, &peaks.power}) {
    values->resize(count);
  }
  const double span = 2.0 * radar.waveform.max_velocity(radar.num_slots());
  const double velocity_step = span / static_cast<double>(map.velocity.size());
  const double range_step = map.range.size() > 1 ? map.range[1] - map.range[0] : 0.0;
  parallel_for(count, [&](int64_t i) {
    if (job) job->throw_if_cancelled();
    const auto [v, r] = peaks.cells[i];
    const double up = peaks.velocity_offset[i] = finder.velocity_offset(tops[i]);
    const double away = peaks.range_offset[i] = finder.range_offset(tops[i]);
    const double shown = finder.tells_velocities() ? map.velocity[v] + up * velocity_step : 0.0;
    peaks.velocity[i] = folded(shown, map.velocity.front() - 0.5 * velocity_step, span);
    peaks.range[i] = map.range[r] + away * range_step;
    peaks.power[i] = found.power[places.place(peaks.cells[i])] / finder.power_in_cell(up, away);
  });
  return peaks;
}

}  // namespace

Peaks find_peaks(const RangeDoppler& map, const Radar& radar, const CfarResult& found, Job* job) {
  require_map_of(map, radar);
  require(found.power.size() == map.velocity.size() * map.range.size(), "found", "must be of the spectrum's cells",
          found.power.size());
  const CellPlaces places(map, !radar.waveform.real);
  if (found.num_beams == 0) return peaks_of(map, radar, found, places, ChannelReader(map, radar, places, found), job);
  return peaks_of(map, radar, found, places, BeamReader(map, radar, places, found), job);
}

}  // namespace echopath
