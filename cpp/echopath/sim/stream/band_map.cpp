#include "echopath/sim/stream/band_map.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "echopath/base/lanes/simd.h"
#include "echopath/spectrum/range_doppler.h"

namespace echopath {
namespace {

constexpr int64_t kLanes = 32;              // chirps side by side
constexpr int64_t kApart = 8;               // between rows of lanes: powers of two would share few sets of the cache
constexpr int64_t kLongestTable = 1 << 16;  // of responses
constexpr int64_t kMostProducts = 60000;    // of cells and columns, above which the samples are quicker

std::vector<double> unit_taper(const Window& window, int count) {
  std::vector<double> taper = window_samples(window, count);
  const double sum = std::accumulate(taper.begin(), taper.end(), 0.0);
  for (double& weight : taper) weight /= sum;
  return taper;
}

// Returns sum_n factor_n e^{j 2 pi k (n - reference) / size} for k = 0 ... size - 1.
std::vector<std::complex<double>> tones_sum(const std::vector<double>& factor, int64_t reference, int64_t size) {
  FftBuffer buffer(size);
  for (int64_t n = 0; n < static_cast<int64_t>(factor.size()); ++n) {
    buffer[((n - reference) % size + size) % size] += factor[static_cast<size_t>(n)];
  }
  Fft(static_cast<int>(size), FftDirection::kBackward).transform(buffer);
  return {buffer.data(), buffer.data() + size};
}

ECHOPATH_INLINE void find_largest_squares(const double* re, const double* im, int64_t count, double* __restrict largest) {
  for (int64_t i = 0; i < count; ++i) {
    const double square = re[i] * re[i] + im[i] * im[i];
    largest[i] = square > largest[i] ? square : largest[i];
  }
}

// Adds up the cells of a band, each times a complex factor: lanes [count, re/im, num_lanes + kApart] to out [re/im,
// num_lanes].
ECHOPATH_INLINE void combine_cells(const double* lanes, int64_t num_lanes, int64_t count, const double* factor,
                                   double* __restrict out) {
  const int64_t stride = num_lanes + kApart;
  for (int64_t first = 0; first < num_lanes; first += kLanes) {
    double re[kLanes] = {}, im[kLanes] = {};
    for (int64_t i = 0; i < count; ++i) {
      const double* const cell_re = lanes + 2 * i * stride + first;
      const double* const cell_im = cell_re + stride;
      const double factor_re = factor[2 * i], factor_im = factor[2 * i + 1];
      for (int64_t c = 0; c < kLanes; ++c) {
        re[c] += factor_re * cell_re[c] - factor_im * cell_im[c];
        im[c] += factor_re * cell_im[c] + factor_im * cell_re[c];
      }
    }
    for (int64_t c = 0; c < kLanes; ++c) {
      out[first + c] = re[c];
      out[num_lanes + first + c] = im[c];
    }
  }
}

// Adds to out [1] the real part of the sum over lanes, cells i and distances d of overlap_d g_{i + d} conj(g_i); overlap
// [count, re/im]. Lanes are taken some at a time, which stay in the first-level cache.
ECHOPATH_INLINE void add_overlaps(const double* lanes, int64_t num_lanes, int64_t count, const double* overlap,
                                  double* __restrict out) {
  const int64_t stride = num_lanes + kApart;
  double sum[kLanes] = {};
  for (int64_t first = 0; first < num_lanes; first += kLanes) {
    for (int64_t i = 0; i < count; ++i) {
      const double* const near = lanes + 2 * i * stride + first;
      double re[kLanes] = {}, im[kLanes] = {};
      for (int64_t d = 0; i + d < count; ++d) {
        const double* const far = near + 2 * d * stride;
        for (int64_t c = 0; c < kLanes; ++c) {
          re[c] += overlap[2 * d] * far[c] - overlap[2 * d + 1] * far[stride + c];
          im[c] += overlap[2 * d] * far[stride + c] + overlap[2 * d + 1] * far[c];
        }
      }
      for (int64_t c = 0; c < kLanes; ++c) sum[c] += near[c] * re[c] + near[stride + c] * im[c];
    }
  }
  for (int64_t c = 0; c < kLanes; ++c) out[0] += sum[c];
}

}  // namespace

BandMap::BandMap(const Radar& radar, const MapWindows& window, int zero_pad, const SpreadMethod* spread)
    : spread_(spread), num_chirps_(radar.waveform.num_chirps), num_lanes_((num_chirps_ + kLanes - 1) / kLanes * kLanes),
      num_ranges_(static_cast<int64_t>(range_axis(radar.waveform, radar.waveform.num_samples * zero_pad).size())),
      num_bins_(int64_t{zero_pad} * radar.waveform.num_samples),
      doppler_taper_(unit_taper(window.velocity, radar.waveform.num_chirps)),
      doppler_fft_(radar.waveform.num_chirps * zero_pad, FftDirection::kForward) {
  if (!spread || radar.waveform.real) return;  // a real sample is not linear in the grid
  const SpreadGrid grid = spread->grid();
  const int64_t size = std::lcm(grid.size, num_bins_);
  if (size > kLongestTable) return;
  std::vector<double> factor = unit_taper(window.range, radar.waveform.num_samples), square = grid.correction;
  for (size_t n = 0; n < factor.size(); ++n) {
    factor[n] *= grid.correction[n];
    square[n] *= grid.correction[n];
  }
  first_cell_ = grid.first;
  response_ = tones_sum(factor, spread->reference_sample(), size);
  overlap_ = tones_sum(square, spread->reference_sample(), grid.size);
}

std::complex<double> BandMap::response(int64_t cell, int64_t column) const {
  const auto size = static_cast<int64_t>(response_.size());
  const int64_t grid_size = static_cast<int64_t>(overlap_.size());
  const int64_t step = (cell + first_cell_) * (size / grid_size) - column * (size / num_bins_);
  return response_[static_cast<size_t>((step % size + size) % size)];
}

bool BandMap::power(const SummedGroups& of, int num_channels, double least, std::vector<uint8_t>& asked,
                    SetPower& out) const {
  if (response_.empty()) return false;
  for (const int group : of.groups) {
    for (int channel = 0; channel < num_channels; ++channel) {
      if (of.signals->has_still(channel, group)) return false;
    }
  }
  const Band band = band_of(of, num_channels);
  const std::vector<int64_t> columns = columns_of(band, least, asked);
  if (band.count * (std::ssize(columns) + band.count / 2) > kMostProducts) {
    asked.assign(static_cast<size_t>(num_ranges_), 0);
    for (const int64_t column : columns) asked[static_cast<size_t>(column)] = 1;
    return false;
  }
  out = {std::vector<double>(static_cast<size_t>(doppler_fft_.size() * num_ranges_)), 0.0};
  std::vector<double> lanes;
  for (int channel = 0; channel < num_channels; ++channel) {
    gather(of, channel, band, lanes);
    add_columns(lanes, band, columns, out.cells);
    if (of.groups.size() == 1) out.mean_square += sum_of_squares(lanes, band.count);
  }
  for (double& cell : out.cells) cell /= num_channels;
  const auto num_samples = static_cast<double>(spread_->grid().correction.size());
  out.mean_square /= static_cast<double>(num_channels * num_chirps_) * num_samples;
  return true;
}

// Returns the largest over chirps and channels, by cell of a row.
std::vector<double> BandMap::magnitude_of(const Synthesizer& signals, int group, int num_channels) const {
  std::vector<double> largest(static_cast<size_t>(spread_->row_length()));
  for (int channel = 0; channel < num_channels; ++channel) {
    for (int chirp = 0; !signals.is_still(channel, group) && chirp < num_chirps_; ++chirp) {
      const RowCells cells = signals.moving_cells(channel, group, chirp);
      run_simd<find_largest_squares>(cells.re, cells.im, cells.count, largest.data() + cells.first);
    }
  }
  for (double& value : largest) value = std::sqrt(value);
  return largest;
}

BandMap::Band BandMap::band_of(const SummedGroups& of, int num_channels) const {
  std::vector<double> sum(static_cast<size_t>(spread_->row_length()));
  for (const int group : of.groups) {
    const std::vector<double> of_group = magnitude_of(*of.signals, group, num_channels);
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += of_group[i];
  }
  const auto is_set = [](double value) { return value > 0.0; };
  const auto begin = std::find_if(sum.begin(), sum.end(), is_set);
  const auto end = std::find_if(sum.rbegin(), std::make_reverse_iterator(begin), is_set).base();
  return {begin - sum.begin(), end - begin, {begin, end}};
}

std::vector<int64_t> BandMap::columns_of(const Band& band, double least, const std::vector<uint8_t>& asked) const {
  std::vector<int64_t> columns;
  for (int64_t column = 0; column < num_ranges_; ++column) {
    if (!asked.empty() && !asked[static_cast<size_t>(column)]) continue;
    double most = 0.0;
    for (int64_t i = 0; i < band.count; ++i) {
      most += band.magnitude[static_cast<size_t>(i)] * std::abs(response(band.first + i, column));
    }
    if (most * most > least) columns.push_back(column);
  }
  return columns;
}

// Sorts the cells of the band of all chirps to [cell, re/im, num_lanes + kApart].
void BandMap::gather(const SummedGroups& of, int channel, const Band& band, std::vector<double>& lanes) const {
  const int64_t stride = num_lanes_ + kApart;
  lanes.assign(static_cast<size_t>(2 * band.count * stride), 0.0);
  for (const int group : of.groups) {
    for (int chirp = 0; !of.signals->is_still(channel, group) && chirp < num_chirps_; ++chirp) {
      const RowCells cells = of.signals->moving_cells(channel, group, chirp);
      const int64_t begin = std::max(cells.first, band.first);
      const int64_t end = std::min(cells.first + cells.count, band.first + band.count);
      double* lane = lanes.data() + 2 * (begin - band.first) * stride + chirp;
      for (int64_t i = begin - cells.first; i < end - cells.first; ++i, lane += 2 * stride) {
        lane[0] += cells.re[i];
        lane[stride] += cells.im[i];
      }
    }
  }
}

void BandMap::add_columns(const std::vector<double>& lanes, const Band& band, const std::vector<int64_t>& columns,
                          std::vector<double>& cells) const {
  std::vector<std::complex<double>> factor(static_cast<size_t>(band.count));
  std::vector<double> profile(static_cast<size_t>(2 * num_lanes_));
  FftBuffer buffer(doppler_fft_.size());
  const int64_t size = buffer.size(), first = size - size / 2;  // row v holds frequency v - size / 2
  for (const int64_t column : columns) {
    for (int64_t i = 0; i < band.count; ++i) factor[static_cast<size_t>(i)] = response(band.first + i, column);
    run_simd<combine_cells>(lanes.data(), num_lanes_, band.count, reinterpret_cast<const double*>(factor.data()),
                            profile.data());
    for (int64_t chirp = 0; chirp < num_chirps_; ++chirp) {
      buffer[chirp] =
          doppler_taper_[static_cast<size_t>(chirp)] *
          std::complex<double>(profile[static_cast<size_t>(chirp)], profile[static_cast<size_t>(num_lanes_ + chirp)]);
    }
    std::fill(buffer.data() + num_chirps_, buffer.data() + size, 0.0);
    doppler_fft_.transform(buffer);
    for (int64_t v = 0; v < size; ++v) {
      cells[static_cast<size_t>(v * num_ranges_ + column)] += std::norm(buffer[(first + v) % size]);
    }
  }
}

// Returns the sum over chirps and samples of |sample|^2.
double BandMap::sum_of_squares(const std::vector<double>& lanes, int64_t count) const {
  std::vector<std::complex<double>> overlap;
  for (int64_t distance = 0; distance < count; ++distance) {
    overlap.push_back((distance > 0 ? 2.0 : 1.0) * overlap_[static_cast<size_t>(distance) % overlap_.size()]);
  }
  double sum = 0.0;
  run_simd<add_overlaps>(lanes.data(), num_lanes_, count, reinterpret_cast<const double*>(overlap.data()), &sum);
  return sum;
}

}  // namespace echopath
