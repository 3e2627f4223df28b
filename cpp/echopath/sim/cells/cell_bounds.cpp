#include "echopath/sim/cells/cell_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "echopath/base/threads/parallel.h"
#include "echopath/fft/fft.h"
#include "echopath/signal/echoes/echo_states.h"
#include "echopath/spectrum/range_doppler.h"

namespace echopath {
namespace {

constexpr double kBeatSpare = 0.25;  // cells
constexpr int kFine = 16;            // steps of a cell in which the response of a window is tabulated
constexpr double kBetweenSteps = 1.01;

// Holds the largest responses of a window to tones within some cells of a bin, by the distance of a cell from it on the
// circle of all cells; there is one table for each of 1, 2, 4, ... cells, the last as wide as the circle.
class WindowReach {
 public:
  WindowReach(const Window& window, int num_cells, int zero_pad) : num_cells_(num_cells) {
    const std::vector<double> fine = response(window, num_cells);
    for (int reach = 1; 2 * reach < num_cells; reach *= 2) tables_.push_back(table(fine, reach, zero_pad));
    tables_.emplace_back(static_cast<size_t>(num_cells * zero_pad), 1.0);
  }
  size_t num_tables() const { return tables_.size(); }
  // [distance in padded cells]
  const std::vector<double>& table_of(size_t index) const { return tables_[index]; }
  // Returns the narrowest table for tones within `half` cells of the bin next to them.
  size_t index_for(double half) const {
    size_t index = 0;
    for (int reach = 1; index + 1 < tables_.size() && half + 0.5 > reach; reach *= 2) ++index;
    return index;
  }

 private:
  // Returns |W| in steps of 1 / kFine cells, 1 at its peak.
  static std::vector<double> response(const Window& window, int num_cells) {
    const std::vector<double> taper = unit_taper(window, num_cells);
    FftBuffer buffer(int64_t{kFine} * num_cells);
    for (int i = 0; i < num_cells; ++i) buffer[i] = taper[i];
    Fft(static_cast<int>(buffer.size()), FftDirection::kForward).transform(buffer);
    std::vector<double> fine;
    for (int64_t i = 0; i < buffer.size(); ++i) fine.push_back(std::min(1.0, kBetweenSteps * std::abs(buffer[i])));
    return fine;
  }

  std::vector<double> table(const std::vector<double>& fine, int reach, int zero_pad) const {
    std::vector<double> values(num_cells_ * zero_pad);
    const auto size = std::ssize(fine);
    for (int64_t i = 0; i < std::ssize(values); ++i) {
      const int64_t centre = i * kFine / zero_pad;
      for (int64_t step = centre - reach * kFine; step <= centre + reach * kFine + 1; ++step) {
        values[i] = std::max(values[i], fine[(step + size) % size]);
      }
    }
    return values;
  }

  int num_cells_;
  std::vector<std::vector<double>> tables_;
};

// Adds a bin of that amplitude to the bounds of all cells of a circle.
void add_bin(double amplitude, int64_t first, const std::vector<double>& reach, std::vector<double>& row) {
  const auto size = std::ssize(row);
  for (int64_t r = 0; r < first; ++r) row[r] += amplitude * reach[r - first + size];
  for (int64_t r = first; r < size; ++r) row[r] += amplitude * reach[r - first];
}

}  // namespace

CellBounds::CellBounds(int64_t num_paths, const Radar& radar, bool per_sample)
    : waveform_(radar.waveform), model_(radar.waveform, 0), per_sample_(per_sample),
      amplitude_(static_cast<size_t>(num_paths)), lowest_(amplitude_.size(), std::numeric_limits<float>::max()),
      highest_(amplitude_.size(), std::numeric_limits<float>::lowest()) {}

void CellBounds::see(std::span<const Echoes> blocks, std::span<const int64_t> first) {
  std::vector<const int64_t*> paths;
  for (const Echoes& block : blocks) {
    paths.push_back(first.data());
    first = first.subspan(static_cast<size_t>(block.num_echoes));
  }
  parallel_for(std::ssize(blocks), [&](int64_t i) {
    const Echoes& block = blocks[i];
    const int num_chirps = waveform_.num_chirps, step = std::max(1, num_chirps / kChirps);
    for (int64_t begin = 0; begin < block.num_echoes; begin += EchoStates::kCapacity) {
      const int count = static_cast<int>(std::min<int64_t>(EchoStates::kCapacity, block.num_echoes - begin));
      for (int chirp = 0; chirp < (block.sampling.is_static() ? 1 : num_chirps); chirp += step) {
        see_some(block, chirp, begin, count, paths[i] + begin);
      }
      see_some(block, num_chirps - 1, begin, count, paths[i] + begin);
    }
  });
}

void CellBounds::see_some(const Echoes& block, int chirp, int64_t begin, int count, const int64_t* first) {
  EchoStates states;
  evaluate_states(block, chirp, begin, count, states);
  for (int i = 0; i < count; ++i) {
    const double swept = states.delay[i] * model_.slope;
    const double beat = swept + states.rate[i] * (model_.centre_frequency - swept);  // Hz, as in carrier.h
    const auto cell = static_cast<float>(beat * model_.sample_interval * waveform_.num_samples);
    const auto path = static_cast<size_t>(first[i]);
    const double re = states.amplitude[2 * i], im = states.amplitude[2 * i + 1];
    amplitude_[path] = std::max(amplitude_[path], static_cast<float>(std::sqrt(re * re + im * im)));
    lowest_[path] = std::min(lowest_[path], cell);
    highest_[path] = std::max(highest_[path], cell);
  }
}

std::vector<double> CellBounds::bounds(std::span<const uint32_t> group, uint32_t num_groups, const Window& window,
                                       int zero_pad) const {
  const int num_cells = waveform_.num_samples;
  const WindowReach reach(window, num_cells, zero_pad);
  const auto num_ranges = static_cast<int64_t>(range_axis(waveform_, num_cells * zero_pad).size());
  const double last_cell = model_.highest_frequency * num_cells + kBeatSpare;
  std::vector<std::vector<size_t>> paths_of(num_groups);
  for (size_t path = 0; path < amplitude_.size(); ++path) {
    const bool is_heard = amplitude_[path] > 0.0f && highest_[path] >= -kBeatSpare && lowest_[path] <= last_cell;
    if (group[path] < num_groups && is_heard) paths_of[group[path]].push_back(path);
  }
  std::vector<double> bounds(num_groups * num_ranges);
  parallel_for(num_groups, [&](int64_t g) {
    // These amplitudes are by table and bin.
    std::vector<std::vector<double>> bins(reach.num_tables(), std::vector<double>(static_cast<size_t>(num_cells)));
    for (const size_t path : paths_of[g]) {
      const double middle = 0.5 * (double{lowest_[path]} + highest_[path]);
      const double half = 0.5 * (double{highest_[path]} - lowest_[path]) + kBeatSpare;
      const int64_t bin = std::llround(middle) % num_cells;
      const size_t table = per_sample_ ? reach.num_tables() - 1 : reach.index_for(half);
      bins[table][bin < 0 ? bin + num_cells : bin] += kSpare * amplitude_[path];
    }
    std::vector<double> row(num_cells * zero_pad);
    for (size_t table = 0; table < bins.size(); ++table) {
      for (int64_t bin = 0; bin < num_cells; ++bin) {
        const double amplitude = bins[table][bin];
        if (amplitude > 0.0) add_bin(amplitude, bin * zero_pad, reach.table_of(table), row);
      }
    }
    // A real sample has the negative frequencies too.
    for (int64_t r = 0; r < num_ranges; ++r) {
      const auto at = static_cast<size_t>(r);
      const double mirrored = waveform_.real ? row[(row.size() - at) % row.size()] : 0.0;
      bounds[g * num_ranges + r] = (row[at] + mirrored) * (row[at] + mirrored);
    }
  });
  return bounds;
}

}  // namespace echopath
