#include "echopath/sim/cells/band_map.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "echopath/base/lanes/simd.h"
#include "echopath/signal/kernels/kernels.h"
#include "echopath/sim/cells/band_loops.h"
#include "echopath/spectrum/range_doppler.h"

namespace echopath {
namespace {

constexpr int64_t kFewColumns = 4;                         // up to which cells need not be sorted to lanes
constexpr int kChirpsTogether = TileAtChirps::kMaxChirps;  // chirps whose rows have the same cells
constexpr int64_t kLongestTable = 1 << 16;                 // of responses
constexpr int64_t kMostProducts = 60000;                   // of cells and columns, above which the samples are quicker

// Returns transforms of 1, 2, 4, ... values, up to twice as many as the widest band has cells.
std::vector<Fft> ffts_of_rows() {
  std::vector<Fft> ffts;
  for (int64_t cells = 0; cells * (cells / 2) <= kMostProducts; cells = ffts.back().size() / 2)
    ffts.emplace_back(1 << ffts.size(), FftDirection::kForward);
  return ffts;
}

// Returns sum_n factor_n e^{j 2 pi k (n - reference) / size} for k = 0 ... size - 1.
std::vector<std::complex<double>> tones_sum(const std::vector<double>& factor, int64_t reference, int64_t size) {
  FftBuffer buffer(size);
  for (int64_t n = 0; n < std::ssize(factor); ++n) {
    buffer[((n - reference) % size + size) % size] += factor[n];
  }
  Fft(static_cast<int>(size), FftDirection::kBackward).transform(buffer);
  return {buffer.data(), buffer.data() + size};
}

// Adds the rows of some chirps to lanes [cell from `first` on, re/im, stride], one chirp in each.
template <int kRows>
void add_lanes_of(const RowCells* rows, int64_t first, int64_t num_cells, int64_t stride, double* lanes) {
  const int64_t begin = std::max(rows[0].first, first), end = std::min(rows[0].first + rows[0].count, first + num_cells);
  for (int64_t cell = begin; cell < end; ++cell) {
    double* const re = lanes + 2 * (cell - first) * stride;
    const int64_t i = cell - rows[0].first;
    for (int c = 0; c < kRows; ++c) re[c] += rows[c].re[i];
    for (int c = 0; c < kRows; ++c) re[stride + c] += rows[c].im[i];
  }
}

// The rows of chirps that are read together have the same cells.
void add_lanes(const RowCells* rows, int count, int64_t first, int64_t num_cells, int64_t stride, double* lanes) {
  if (count == kChirpsTogether) return add_lanes_of<kChirpsTogether>(rows, first, num_cells, stride, lanes);
  for (int i = 0; i < count; ++i) add_lanes_of<1>(rows + i, first, num_cells, stride, lanes + i);
}

}  // namespace

BandMap::BandMap(const Radar& radar, const MapWindows& window, int zero_pad, const SpreadMethod* spread)
    : spread_(spread), num_chirps_(radar.waveform.num_chirps),
      num_lanes_((num_chirps_ + band_loops::kLanes - 1) / band_loops::kLanes * band_loops::kLanes),
      num_ranges_(static_cast<int64_t>(range_axis(radar.waveform, radar.waveform.num_samples * zero_pad).size())),
      num_bins_(int64_t{zero_pad} * radar.waveform.num_samples),
      doppler_taper_(unit_taper(window.velocity, radar.waveform.num_chirps)),
      doppler_fft_(radar.waveform.num_chirps * zero_pad,
                   radar.waveform.falls() ? FftDirection::kBackward : FftDirection::kForward) {
  if (!spread || radar.waveform.real) return;  // a real sample is not linear in the grid
  const SpreadGrid grid = spread->grid();
  const int64_t size = std::lcm(grid.size, num_bins_);
  if (size > kLongestTable) return;
  row_ffts_ = ffts_of_rows();
  std::vector<double> factor = unit_taper(window.range, radar.waveform.num_samples), square = grid.correction;
  for (size_t n = 0; n < factor.size(); ++n) {
    factor[n] *= grid.correction[n];
    square[n] *= grid.correction[n];
  }
  first_cell_ = grid.first;
  response_ = tones_sum(factor, spread->reference_sample(), size);
  for (const std::complex<double>& value : response_) size_of_response_.push_back(std::abs(value));
  overlap_ = tones_sum(square, spread->reference_sample(), grid.size);
}

// Returns the place of what a cell adds to a column in the tables.
size_t BandMap::place_of(int64_t cell, int64_t column) const {
  const auto size = std::ssize(response_);
  const int64_t grid_size = std::ssize(overlap_);
  const int64_t step = (cell + first_cell_) * (size / grid_size) - column * (size / num_bins_);
  return static_cast<size_t>((step % size + size) % size);
}

bool BandMap::power(const SummedGroups& of, int num_channels, double least, std::vector<uint8_t>& asked,
                    SetPower& out) const {
  if (response_.empty()) return false;
  for (const int group : of.groups) {
    for (int channel = 0; channel < num_channels; ++channel) {
      if (of.signals->has_still(channel, group)) return false;
    }
  }
  const bool takes_all = least <= 0.0 && !asked.empty();
  const Band band = takes_all ? extent_of(of, num_channels) : band_of(of, num_channels);
  const std::vector<int64_t> columns = columns_of(band, takes_all ? -1.0 : least, asked);
  if (band.count * (std::ssize(columns) + band.count / 2) > kMostProducts) {
    asked.assign(num_ranges_, 0);
    for (const int64_t column : columns) asked[column] = 1;
    return false;
  }
  out = {std::vector<double>(static_cast<size_t>(doppler_fft_.size() * num_ranges_)), 0.0};
  if (band.count == 0) return true;  // all its rows are zero
  const bool is_one = of.groups.size() == 1, takes_pairs = is_one && is_quicker_over_pairs(band);
  const bool needs_lanes = takes_pairs || std::ssize(columns) > kFewColumns;
  if (!needs_lanes) {
    for (const int64_t column : columns) add_column(of, num_channels, band, column, out.cells);
  }
  std::vector<double> lanes;
  for (int channel = 0; needs_lanes && channel < num_channels; ++channel) {
    gather(of, channel, band, lanes);
    add_columns(lanes, band, columns, out.cells);
    if (takes_pairs) out.mean_square += sum_over_pairs(lanes, band.count);
  }
  if (is_one && !takes_pairs) out.mean_square = sum_of_transforms(of, num_channels, band);
  for (double& cell : out.cells) cell /= num_channels;
  const auto num_samples = static_cast<double>(spread_->grid().correction.size());
  out.mean_square /= static_cast<double>(num_channels * num_chirps_) * num_samples;
  return true;
}

// Returns the largest over chirps and channels, by cell of a row.
std::vector<double> BandMap::magnitude_of(const Synthesizer& signals, int group, int num_channels) const {
  std::vector<double> largest(spread_->row_length());
  for (int channel = 0; channel < num_channels; ++channel) {
    for (int chirp = 0; !signals.is_still(channel, group) && chirp < num_chirps_; chirp += kChirpsTogether) {
      const RowCells cells = signals.moving_cells(channel, group, chirp);
      double* const out = largest.data() + cells.first;
      if (chirp + kChirpsTogether <= num_chirps_) {
        const int64_t stride = signals.moving_cells(channel, group, chirp + 1).re - cells.re;
        run_simd<band_loops::find_largest_squares<kChirpsTogether>>(cells.re, cells.im, stride, cells.count, out);
        continue;
      }
      for (int last = chirp; last < num_chirps_; ++last) {
        const RowCells row = signals.moving_cells(channel, group, last);
        run_simd<band_loops::find_largest_squares<1>>(row.re, row.im, int64_t{0}, row.count, out);
      }
    }
  }
  for (double& value : largest) value = std::sqrt(value);
  return largest;
}

BandMap::Band BandMap::band_of(const SummedGroups& of, int num_channels) const {
  std::vector<double> sum(spread_->row_length());
  for (const int group : of.groups) {
    const std::vector<double> of_group = magnitude_of(*of.signals, group, num_channels);
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += of_group[i];
  }
  const auto is_set = [](double value) { return value > 0.0; };
  const auto begin = std::ranges::find_if(sum, is_set);
  const auto end = std::find_if(sum.rbegin(), std::make_reverse_iterator(begin), is_set).base();
  return {begin - sum.begin(), end - begin, {begin, end}};
}

// Returns the cells that any of the rows has, without their magnitudes.
BandMap::Band BandMap::extent_of(const SummedGroups& of, int num_channels) const {
  int64_t first = spread_->row_length(), end = 0;
  for (const int group : of.groups) {
    for (int channel = 0; channel < num_channels; ++channel) {
      for (int chirp = 0; !of.signals->is_still(channel, group) && chirp < num_chirps_; chirp += kChirpsTogether) {
        const RowCells cells = of.signals->moving_cells(channel, group, chirp);
        first = std::min(first, cells.first);
        end = std::max(end, cells.first + cells.count);
      }
    }
  }
  return {std::min(first, end), std::max<int64_t>(end - first, 0), {}};
}

std::vector<int64_t> BandMap::columns_of(const Band& band, double least, const std::vector<uint8_t>& asked) const {
  std::vector<int64_t> columns;
  for (int64_t column = 0; column < num_ranges_; ++column) {
    if (!asked.empty() && !asked[column]) continue;
    double most = 0.0;
    for (int64_t i = 0; i < std::ssize(band.magnitude); ++i) {
      most += band.magnitude[i] * size_of_response_[place_of(band.first + i, column)];
    }
    if (most * most > least) columns.push_back(column);
  }
  return columns;
}

// Sorts the cells of the band of all chirps to [cell, re/im, num_lanes + band_loops::kApart].
void BandMap::gather(const SummedGroups& of, int channel, const Band& band, std::vector<double>& lanes) const {
  const int64_t stride = num_lanes_ + band_loops::kApart;
  lanes.assign(2 * band.count * stride, 0.0);
  for (const int group : of.groups) {
    for (int chirp = 0; !of.signals->is_still(channel, group) && chirp < num_chirps_; chirp += kChirpsTogether) {
      RowCells rows[kChirpsTogether];
      const int count = static_cast<int>(std::min<int64_t>(kChirpsTogether, num_chirps_ - chirp));
      for (int i = 0; i < count; ++i) rows[i] = of.signals->moving_cells(channel, group, chirp + i);
      add_lanes(rows, count, band.first, band.count, stride, lanes.data() + chirp);
    }
  }
}

// Adds a column of all channels straight from the rows.
void BandMap::add_column(const SummedGroups& of, int num_channels, const Band& band, int64_t column,
                         std::vector<double>& cells) const {
  std::vector<double> factor_re, factor_im;
  for (int64_t i = 0; i < band.count; ++i) {
    const std::complex<double> factor = response_[place_of(band.first + i, column)];
    factor_re.push_back(factor.real());
    factor_im.push_back(factor.imag());
  }
  FftBuffer buffer(doppler_fft_.size());
  for (int channel = 0; channel < num_channels; ++channel) {
    std::fill_n(buffer.data(), num_chirps_, 0.0);
    for (const int group : of.groups) {
      for (int chirp = 0; !of.signals->is_still(channel, group) && chirp < num_chirps_; ++chirp) {
        const RowCells row = of.signals->moving_cells(channel, group, chirp);
        const int64_t begin = std::max(row.first, band.first);
        const int64_t count = std::min(row.first + row.count, band.first + band.count) - begin;
        if (count <= 0) continue;
        run_simd<band_loops::add_product>(row.re + (begin - row.first), row.im + (begin - row.first),
                                          &factor_re[begin - band.first], &factor_im[begin - band.first], count,
                                          reinterpret_cast<double*>(&buffer[chirp]));
      }
    }
    add_velocities(buffer, column, cells);
  }
}

void BandMap::add_columns(const std::vector<double>& lanes, const Band& band, const std::vector<int64_t>& columns,
                          std::vector<double>& cells) const {
  std::vector<std::complex<double>> factor(band.count);
  std::vector<double> profile(2 * num_lanes_);
  FftBuffer buffer(doppler_fft_.size());
  for (const int64_t column : columns) {
    for (int64_t i = 0; i < band.count; ++i) factor[i] = response_[place_of(band.first + i, column)];
    run_simd<band_loops::combine_cells>(lanes.data(), num_lanes_, band.count, reinterpret_cast<const double*>(factor.data()),
                                        profile.data());
    for (int64_t chirp = 0; chirp < num_chirps_; ++chirp) {
      buffer[chirp] = {profile[chirp], profile[num_lanes_ + chirp]};
    }
    add_velocities(buffer, column, cells);
  }
}

// Adds the power of a column at all velocities. The buffer holds its value in every chirp, and is used up.
void BandMap::add_velocities(FftBuffer& buffer, int64_t column, std::vector<double>& cells) const {
  const int64_t size = buffer.size(), first = size - size / 2;  // row v holds frequency v - size / 2
  for (int64_t chirp = 0; chirp < num_chirps_; ++chirp) buffer[chirp] *= doppler_taper_[chirp];
  std::fill(buffer.data() + num_chirps_, buffer.data() + size, 0.0);
  doppler_fft_.transform(buffer);
  for (int64_t v = 0; v < size; ++v) {
    cells[v * num_ranges_ + column] += std::norm(buffer[(first + v) % size]);
  }
}

}  // namespace echopath
