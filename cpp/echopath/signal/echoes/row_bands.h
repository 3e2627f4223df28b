#pragma once
// Keeps rows of many channels and groups, of each only the cells near its echoes: most groups have echoes at few ranges.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "echopath/signal/kernels/kernels.h"

namespace echopath {

// Names some neighbouring cells of a row; all others are zero.
struct RowCells {
  int64_t first = 0, count = 0;
  const double *re = nullptr, *im = nullptr;
};

// Holds the rows of a few chirps, which one thread at a time may change.
class RowBands {
 public:
  // Forgets all rows but keeps the memory. Rows are numbered from 0 on, those of a channel by group, channel after channel;
  // each has `row_length` cells.
  void start(size_t num_channels, size_t num_groups, int num_chirps, int64_t row_length);

  bool has(size_t row) const { return bands_[row].count > 0; }
  RowCells cells(size_t row, int chirp) const;
  // Returns where the cells of a row stand, which now has all of these and may have moved. A row that grows takes the cells
  // of its group in the channel before, too: it is likely to need them, as antennas of an array see nearly the same delays.
  TileRows room(size_t row, const CellRange& cells);
  size_t num_bytes() const;

 private:
  struct Band {
    int64_t first = 0, count = 0;
    double* values = nullptr;  // [chirp, re/im, count]
  };
  // Holds memory of which the first `used` values are in use.
  struct Chunk {
    std::unique_ptr<double[]> values;
    size_t size = 0, used = 0;
  };
  size_t size_of(const Band& band) const { return static_cast<size_t>(num_parts_ * band.count); }
  CellRange cells_to_come(size_t row, const CellRange& cells) const;
  void widen(Band& band, const CellRange& cells);
  double* take(size_t count);
  bool grows_in_place(const Band& before, size_t size);

  size_t num_groups_ = 0;
  int64_t row_length_ = 0;
  int64_t num_parts_ = 0;  // of real and imaginary parts
  std::vector<Band> bands_;
  std::vector<Chunk> chunks_;
  size_t num_chunks_ = 0;  // of those, which hold rows
};

}  // namespace echopath
