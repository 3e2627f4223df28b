#pragma once
// Labels the cells of a map by the powers of its parts, in pure functions on arrays. A map is [rows, columns], row-major,
// of N cells: velocities (or azimuths) and ranges. Powers are in W, finite and not negative.
#include <cstdint>
#include <span>
#include <vector>

namespace echopath {

inline constexpr int16_t kNoLabel = -1;

// Returns the power of each part over the sum of all parts, [K, N] from [K, N]: it sums to 1 in each cell and is 0 where
// no part has power. Raises invalid_argument unless num_parts in [1, 32767] divides the number of powers.
std::vector<double> power_shares(std::span<const double> power, int64_t num_parts);

// Tells which cells have something to label, [N] of 0 or 1.
struct CellMask {
  std::vector<uint8_t> above_noise;  // power above noise_floor
  std::vector<uint8_t> labelled;     // above noise, and at least dynamic_range times the power of the strongest cell
};

// `power` [N] is that of the whole; noise_floor in W, >= 0; dynamic_range is a ratio of powers in [0, 1], 0 for no limit.
// Raises invalid_argument for others.
CellMask cell_mask(std::span<const double> power, double noise_floor, double dynamic_range);

// Returns the part of the largest power in each cell, the first of equal ones, [N] from [K, N]; kNoLabel where `labelled`
// [N] is 0 or no part has power. Raises as power_shares.
std::vector<int16_t> strongest_part(std::span<const double> power, int64_t num_parts, std::span<const uint8_t> labelled);

struct MapShape {
  int64_t rows = 0, columns = 0;
  bool rows_wrap = false;  // the first row follows the last: velocities fold

  int64_t size() const { return rows * columns; }
};

// Describes the cells of one label.
struct LabelRegion {
  int64_t num_cells = 0;                  // 0: the other fields have no meaning
  int64_t peak_row = 0, peak_column = 0;  // strongest cell, the first of equal ones
  double peak_power = 0.0;                // W, of the label there
  // These bound the smallest box that holds the region, both ends included; first_row > last_row where the box runs over the
  // end of wrapping rows.
  int64_t first_row = 0, last_row = 0, first_column = 0, last_column = 0;
};

// Returns the regions of all labels, [L]. label [N] holds indices of labels or kNoLabel; power [N] is that of the label
// that the cell has. Rows that wrap leave out the largest gap between occupied rows; of equal gaps the one over the end
// of the axis, else the first. Raises invalid_argument when sizes differ or a label is not below num_labels.
std::vector<LabelRegion> label_regions(std::span<const int16_t> label, std::span<const double> power, int64_t num_labels,
                                       const MapShape& shape);

}  // namespace echopath
