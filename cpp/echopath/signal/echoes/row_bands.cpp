#include "echopath/signal/echoes/row_bands.h"

#include <algorithm>

namespace echopath {
namespace {

// Doubles of the first chunk and of the largest one. Each has twice as many as the one before, or as many as a larger row
// has.
constexpr size_t kFirstChunk = size_t{1} << 12, kLargestChunk = size_t{1} << 16;

}  // namespace

void RowBands::start(size_t num_channels, size_t num_groups, int num_chirps, int64_t row_length) {
  num_groups_ = num_groups;
  row_length_ = row_length;
  num_parts_ = 2 * num_chirps;
  bands_.assign(num_channels * num_groups, {});
  num_chunks_ = 0;
}

RowCells RowBands::cells(size_t row, int chirp) const {
  const Band& band = bands_[row];
  const double* const re = band.values + 2 * chirp * band.count;
  return {band.first, band.count, re, re + band.count};
}

size_t RowBands::num_bytes() const {
  size_t bytes = bands_.capacity() * sizeof(Band);
  for (const Chunk& chunk : chunks_) bytes += chunk.size * sizeof(double);
  return bytes;
}

TileRows RowBands::room(size_t row, const CellRange& cells) {
  Band& band = bands_[row];
  if (cells.first < band.first || cells.end > band.first + band.count) widen(band, cells_to_come(row, cells));
  return {band.values - band.first, band.count, 2 * band.count};
}

CellRange RowBands::cells_to_come(size_t row, const CellRange& cells) const {
  if (row < num_groups_ || !has(row - num_groups_)) return cells;
  const Band& like = bands_[row - num_groups_];
  // The first channel knows none before it: the second may need a cell more than it on either side, and later ones what the
  // second has.
  const int64_t more = row < 2 * num_groups_ ? 1 : 0;
  return {std::min(cells.first, std::max<int64_t>(like.first - more, 0)),
          std::max(cells.end, std::min(like.first + like.count + more, row_length_))};
}

// Returns room for `count` values, which are not set. Chunks too small for it are passed over.
double* RowBands::take(size_t count) {
  const auto has_room = [&](const Chunk& chunk) { return chunk.size - chunk.used >= count; };
  if (num_chunks_ == 0 || !has_room(chunks_[num_chunks_ - 1])) {
    size_t next = num_chunks_;
    while (next < chunks_.size() && chunks_[next].size < count) ++next;
    if (next == chunks_.size()) {
      const size_t usual = chunks_.empty() ? kFirstChunk : std::min(2 * chunks_.back().size, kLargestChunk);
      const size_t size = std::max(usual, count);
      chunks_.push_back({std::make_unique_for_overwrite<double[]>(size), size, 0});
    }
    std::swap(chunks_[num_chunks_], chunks_[next]);
    chunks_[num_chunks_++].used = 0;
  }
  Chunk& chunk = chunks_[num_chunks_ - 1];
  chunk.used += count;
  return chunk.values.get() + (chunk.used - count);
}

// Only the row that was made or grew last stands at the end of its chunk.
bool RowBands::grows_in_place(const Band& before, size_t size) {
  if (before.count == 0) return false;
  Chunk& chunk = chunks_[num_chunks_ - 1];
  const size_t more = size - size_of(before);
  if (before.values + size_of(before) != chunk.values.get() + chunk.used || chunk.size - chunk.used < more) return false;
  chunk.used += more;
  return true;
}

// Parts are moved from the last on, because a part of a row that grows in place may go where the next one was.
void RowBands::widen(Band& band, const CellRange& cells) {
  const Band before = band.count > 0 ? band : Band{cells.first, 0, nullptr};
  band.first = std::min(before.first, cells.first);
  band.count = std::max(before.first + before.count, cells.end) - band.first;
  if (!grows_in_place(before, size_of(band))) band.values = take(size_of(band));
  for (int64_t part = num_parts_ - 1; part >= 0; --part) {
    const double* const from = before.values + part * before.count;
    double* const to = band.values + part * band.count;
    double* const kept = to + (before.first - band.first);
    std::copy_backward(from, from + before.count, kept + before.count);
    std::fill(to, kept, 0.0);
    std::fill(kept + before.count, to + band.count, 0.0);
  }
}

}  // namespace echopath
