#pragma once
// Keeps rows of many channels and groups, of each only the cells near its echoes: most groups have echoes at few ranges.
#include <cstddef>
#include <cstdint>
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
  // Forgets all rows but keeps the memory. Rows are numbered from 0 on.
  void start(size_t num_rows, int num_chirps);

  bool has(size_t row) const { return bands_[row].count > 0; }
  RowCells cells(size_t row, int chirp) const;
  // Returns where the cells of a row stand, which now has all of these and may have moved.
  TileRows room(size_t row, const CellRange& cells);
  size_t num_bytes() const { return values_.capacity() * sizeof(double) + bands_.capacity() * sizeof(Band); }

 private:
  struct Band {
    int64_t first = 0, count = 0;
    size_t place = 0;  // in `values_`, of [chirp, re/im, count]
  };
  size_t size_of(const Band& band) const { return static_cast<size_t>(num_parts_ * band.count); }
  void widen(Band& band, const CellRange& cells);

  int64_t num_parts_ = 0;  // of real and imaginary parts
  std::vector<Band> bands_;
  std::vector<double> values_;
};

}  // namespace echopath
