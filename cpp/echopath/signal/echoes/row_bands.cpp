#include "echopath/signal/echoes/row_bands.h"

#include <algorithm>

namespace echopath {

void RowBands::start(size_t num_rows, int num_chirps) {
  num_parts_ = 2 * num_chirps;
  bands_.assign(num_rows, {});
  values_.clear();
}

RowCells RowBands::cells(size_t row, int chirp) const {
  const Band& band = bands_[row];
  const double* const re = values_.data() + band.place + static_cast<size_t>(2 * chirp * band.count);
  return {band.first, band.count, re, re + band.count};
}

TileRows RowBands::room(size_t row, const CellRange& cells) {
  Band& band = bands_[row];
  if (cells.first < band.first || cells.end > band.first + band.count) widen(band, cells);
  return {values_.data() + band.place - band.first, band.count, 2 * band.count};
}

// The row that was written last grows where it stands, others move behind it. Parts are moved from the last on, because a
// part may go where the next one was.
void RowBands::widen(Band& band, const CellRange& cells) {
  const Band before = band.count > 0 ? band : Band{cells.first, 0, values_.size()};
  band.first = std::min(before.first, cells.first);
  band.count = std::max(before.first + before.count, cells.end) - band.first;
  band.place = before.place + size_of(before) == values_.size() ? before.place : values_.size();
  values_.resize(band.place + size_of(band));
  for (int64_t part = num_parts_ - 1; part >= 0; --part) {
    const double* const from = values_.data() + before.place + part * before.count;
    double* const to = values_.data() + band.place + part * band.count;
    double* const kept = to + (before.first - band.first);
    std::copy_backward(from, from + before.count, kept + before.count);
    std::fill(to, kept, 0.0);
    std::fill(kept + before.count, to + band.count, 0.0);
  }
}

}  // namespace echopath
