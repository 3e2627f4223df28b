#pragma once
// What tests of CFAR share: a design by its window and rate, and training cells from the words of cfar.h, cell by cell.
#include <algorithm>
#include <cstdlib>
#include <vector>

#include "echopath/spectrum/cfar/cfar.h"

namespace echopath::testing {

inline CfarDesign design_of(WindowKind kind, int zero_pad, CfarWindow cells, double rate, int num_channels = 1) {
  CfarDesign design;
  design.false_alarm_rate = rate;
  design.cells = cells;
  design.noise = {Window{kind, 80.0}, 64, 128, zero_pad, num_channels};
  return design;
}

struct Place {
  int velocity, range;
};

// Returns the training cells of (0, range).
inline std::vector<Place> training_cells(const CfarWindow& w, int range, int num_ranges) {
  std::vector<Place> cells;
  const int reach = w.reach_range(), middle = std::clamp(range, reach, num_ranges - 1 - reach);
  for (int v = -w.reach_velocity(); v <= w.reach_velocity(); ++v) {
    if (std::abs(v) > w.guard_velocity) {
      for (int r = middle - reach; r <= middle + reach; ++r) cells.push_back({v, r});
      continue;
    }
    int left = 0;
    for (int r = range - w.guard_range - 1; r >= 0 && left < w.training_range; --r, ++left) cells.push_back({v, r});
    int right = 0;
    for (int r = range + w.guard_range + 1; r < num_ranges && right < 2 * w.training_range - left; ++r, ++right) {
      cells.push_back({v, r});
    }
    for (int r = range - w.guard_range - 1 - left; left + right < 2 * w.training_range; --r, ++left) cells.push_back({v, r});
  }
  return cells;
}

}  // namespace echopath::testing
