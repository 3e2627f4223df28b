// The part of BandMap that finds the mean square of a signal.
#include <algorithm>
#include <bit>

#include "echopath/base/lanes/interleave.h"
#include "echopath/base/lanes/simd.h"
#include "echopath/sim/cells/band_loops.h"
#include "echopath/sim/cells/band_map.h"

namespace echopath {
namespace {

constexpr int64_t kFewCells = 64;  // up to which all pairs of cells are quicker than transforms of the rows

}  // namespace

bool BandMap::is_quicker_over_pairs(const Band& band) const { return band.count <= kFewCells; }

// Returns the sum over the chirps and samples of a channel of |sample|^2, from its cells sorted to lanes. It is the real
// part of sum_d r_d overlap_d over the distances d of both signs, with r_d = sum_i g_{i + d} conj(g_i) over the cells of
// all rows.
double BandMap::sum_over_pairs(const std::vector<double>& lanes, int64_t count) const {
  // Of two distances +-d the real parts are the same.
  std::vector<std::complex<double>> overlap;
  for (int64_t d = 0; d < count; ++d) {
    overlap.push_back((d == 0 ? 1.0 : 2.0) * overlap_[static_cast<size_t>(d) % overlap_.size()]);
  }
  double sum = 0.0;
  run_simd<band_loops::add_overlaps>(lanes.data(), num_lanes_, count, reinterpret_cast<const double*>(overlap.data()), &sum);
  return sum;
}

// Returns that sum for a group, over all channels, straight from the rows: the numbers r_d are the Fourier transform of the
// squares of the transforms of all rows, which are long enough for the distances of both signs.
double BandMap::sum_of_transforms(const SummedGroups& of, int num_channels, const Band& band) const {
  if (band.count == 0) return 0.0;
  const Fft& fft = row_ffts_[std::bit_width(static_cast<uint64_t>(2 * band.count - 1))];
  const int64_t size = fft.size();
  FftBuffer buffer(size);
  std::vector<double> squares(size);
  const int group = of.groups.front();
  for (int channel = 0; channel < num_channels; ++channel) {
    for (int chirp = 0; !of.signals->is_still(channel, group) && chirp < num_chirps_; ++chirp) {
      const RowCells cells = of.signals->moving_cells(channel, group, chirp);
      const int64_t begin = std::max(cells.first, band.first);
      const int64_t count = std::min(cells.first + cells.count, band.first + band.count) - begin;
      if (count <= 0) continue;
      std::fill_n(buffer.data(), size, 0.0);
      run_simd<interleave>(cells.re + (begin - cells.first), cells.im + (begin - cells.first), count,
                           reinterpret_cast<double*>(buffer.data()));
      fft.transform(buffer);
      run_simd<band_loops::add_squares>(reinterpret_cast<const double*>(buffer.data()), size, squares.data());
    }
  }
  std::ranges::copy(squares, buffer.data());
  fft.transform(buffer);  // conj(r_d) times its length at d, as all squares are real
  double sum = buffer[0].real() * overlap_[0].real();
  for (int64_t d = 1; d < band.count; ++d) {
    sum += 2.0 * (std::conj(buffer[d]) * overlap_[static_cast<size_t>(d) % overlap_.size()]).real();
  }
  return sum / static_cast<double>(size);
}

}  // namespace echopath
