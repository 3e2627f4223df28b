#pragma once
// Computes the range-Doppler map of a signal whose echoes lie at neighbouring ranges, a band, directly from the grid of the
// NUFFT. It computes neither the samples of the signal nor the range columns in which the signal is too weak to matter.
//
// Grid cell i holds g_i, and sample n is c_n sum_i g_i e^{j 2 pi i (n - n0) / G} (signal/methods/nufft.cpp). The windowed
// Fourier transform at range bin r of B is linear in them,
//   p_r = sum_i g_i m(i / G - r / B),  m(x) = sum_n w_n c_n e^{j 2 pi x (n - n0)},
// up to a phase of the bin, which is the same in all chirps and does not matter for powers. With the maxima over chirps
// and channels of |g_i|, sum_i |g_i| |m(i / G - r / B)| bounds every cell of column r, as windows divide by their sum.
#include <complex>
#include <cstdint>
#include <vector>

#include "echopath/fft/fft.h"
#include "echopath/radar/radar.h"
#include "echopath/signal/methods/method.h"
#include "echopath/signal/synthesizer.h"
#include "echopath/spectrum/window.h"

namespace echopath {

// Holds the power of a signal in the cells of a range-Doppler map, mean over the channels.
struct SetPower {
  std::vector<double> cells;  // [V * R] W
  double mean_square = 0.0;   // W, mean over channels, chirps and samples, of one group; of several 0
};

// Names groups of a synthesizer whose fields add up.
struct SummedGroups {
  const Synthesizer* signals = nullptr;
  std::vector<int> groups;
};

class BandMap {
 public:
  // Raises as MapTransform. `spread` must outlive it; null: no signal is a band.
  BandMap(const Radar& radar, const MapWindows& window, int zero_pad, const SpreadMethod* spread);

  // Writes the power of the summed field of some groups and returns true, where their echoes fill so few cells of the grid
  // that this is quicker than a transform of the samples. Columns whose power cannot exceed `least` (W) are left at 0, as
  // are columns that are not marked in `asked` ([R] 1 or 0; empty marks all). Where it returns false, it has written nothing
  // to `out`, and `asked` leaves out the columns that it found to be too weak. It has no parallel loop, and several threads
  // may use it.
  bool power(const SummedGroups& of, int num_channels, double least, std::vector<uint8_t>& asked, SetPower& out) const;

 private:
  struct Band {
    int64_t first = 0, count = 0;   // cells of a row
    std::vector<double> magnitude;  // [count], the largest over chirps and channels, sums over the groups; or empty
  };
  std::vector<double> magnitude_of(const Synthesizer& signals, int group, int num_channels) const;
  Band band_of(const SummedGroups& of, int num_channels) const;
  Band extent_of(const SummedGroups& of, int num_channels) const;
  std::vector<int64_t> columns_of(const Band& band, double least, const std::vector<uint8_t>& asked) const;
  size_t place_of(int64_t cell, int64_t column) const;
  void gather(const SummedGroups& of, int channel, const Band& band, std::vector<double>& lanes) const;
  void add_column(const SummedGroups& of, int num_channels, const Band& band, int64_t column,
                  std::vector<double>& cells) const;
  void add_velocities(FftBuffer& buffer, int64_t column, std::vector<double>& cells) const;
  void add_columns(const std::vector<double>& lanes, const Band& band, const std::vector<int64_t>& columns,
                   std::vector<double>& cells) const;
  // The sums of |sample|^2 are found in one of two ways, whichever is quicker.
  bool is_quicker_over_pairs(const Band& band) const;
  double sum_over_pairs(const std::vector<double>& lanes, int64_t count) const;
  double sum_of_transforms(const SummedGroups& of, int num_channels, const Band& band) const;

  const SpreadMethod* spread_;
  int64_t num_chirps_, num_lanes_, num_ranges_, num_bins_, first_cell_ = 0;
  std::vector<double> doppler_taper_;  // [chirp]
  Fft doppler_fft_;
  std::vector<Fft> row_ffts_;                   // of 2^k values, by k
  std::vector<std::complex<double>> response_;  // m at multiples of 1 / size, empty where there is no band
  std::vector<double> size_of_response_;        // |m| likewise
  std::vector<std::complex<double>> overlap_;   // sum_n c_n^2 e^{j 2 pi d (n - n0) / G} by d
};

}  // namespace echopath
