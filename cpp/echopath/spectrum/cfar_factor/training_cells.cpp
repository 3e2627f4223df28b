#include "echopath/spectrum/cfar_factor/training_cells.h"

#include <cstdlib>

namespace echopath {
namespace {

// Calls visit(cell, rows, columns) with the place of each training cell and its distance from the cell under test.
template <class Visit>
void visit_training_cells(const CfarWindow& window, const Visit& visit) {
  for (int rows = -window.reach_velocity(); rows <= window.reach_velocity(); ++rows) {
    for (int columns = -window.reach_range(); columns <= window.reach_range(); ++columns) {
      if (std::abs(rows) <= window.guard_velocity && std::abs(columns) <= window.guard_range) continue;
      visit((rows + window.reach_velocity()) * window.num_columns() + columns + window.reach_range(), rows, columns);
    }
  }
}

}  // namespace

CellGroup training_cells(const CfarWindow& window) {
  CellGroup cells;
  visit_training_cells(window, [&](int cell, int, int) { cells.push_back(cell); });
  return cells;
}

std::array<CellGroup, 2> halves_of_training_cells(const CfarWindow& window) {
  std::array<CellGroup, 2> halves;
  visit_training_cells(window, [&](int cell, int rows, int columns) {
    if (const auto half = window.half_of(rows, columns)) halves[*half].push_back(cell);
  });
  return halves;
}

}  // namespace echopath
