#pragma once
// Lists the training cells of a CFAR window by their places in its rectangle.
#include <array>
#include <vector>

#include "echopath/spectrum/cfar_factor/cfar_window.h"

namespace echopath {

// Cells are given by row * num_columns + column of the window's rectangle, ascending.
using CellGroup = std::vector<int>;

CellGroup training_cells(const CfarWindow& window);
// Returns the two halves as of CfarWindow::half_of.
std::array<CellGroup, 2> halves_of_training_cells(const CfarWindow& window);

}  // namespace echopath
