#pragma once
// Selects the training cells, from which the noise of a cell under test is estimated.
#include <array>
#include <cstdint>
#include <optional>

#include "echopath/spectrum/window.h"

namespace echopath {

// Half widths are in cells: a rectangle of `guard` cells about the cell under test is left out, and `training` cells around
// it are taken. The velocity axis wraps around; at the ends of the range axis the training cells that would lie outside are
// taken on the other side, so that their number is the same everywhere.
struct CfarWindow {
  int guard_velocity = 0, guard_range = 0;
  int training_velocity = 0, training_range = 0;

  int reach_velocity() const { return guard_velocity + training_velocity; }
  int reach_range() const { return guard_range + training_range; }
  int num_rows() const { return 2 * reach_velocity() + 1; }
  int num_columns() const { return 2 * reach_range() + 1; }
  int64_t num_training() const;
  // Returns in which half of the training cells one lies, 0 or 1, that is (rows, columns) from the cell under test in the
  // middle: among nearer or farther ranges, or, without training cells along range, among lower or higher velocities. Cells
  // at the range of the cell under test belong to neither half of ranges.
  std::optional<int> half_of(int rows, int columns) const;
  int64_t num_in_half() const;
  bool operator==(const CfarWindow&) const = default;

  // Raises invalid_argument naming the field unless there are training cells and all of them fit into
  // num_velocities x num_ranges cells.
  void validate(int64_t num_velocities, int64_t num_ranges) const;
};

struct CellSpan {
  int64_t first = 0, count = 0;
};

// inner_spans returns the training cells of a cell at `range` in its own row and those within guard_velocity of it, one span
// on each side; outer_span returns those in a row beyond, in one span.
std::array<CellSpan, 2> inner_spans(const CfarWindow& window, int64_t range, int64_t num_ranges);
CellSpan outer_span(const CfarWindow& window, int64_t range, int64_t num_ranges);

// Returns the cells from a tone to the first null of its main lobe, rounded up, which guard cells must cover.
int main_lobe_cells(const Window& window, int num_samples, int zero_pad);

}  // namespace echopath
