#include "echopath/label/cells/cells.h"

#include <algorithm>
#include <limits>
#include <string>

#include "echopath/base/errors.h"
#include "echopath/base/threads/parallel.h"

namespace echopath {
namespace {

constexpr int64_t kCellsPerTask = 1 << 13;
constexpr int64_t kMaxParts = std::numeric_limits<int16_t>::max();

// Returns the number of cells that `size` values of `count` parts or channels have.
int64_t cells_of(size_t size, int64_t count, const char* argument) {
  require(count >= 1 && count <= kMaxParts, argument, "must be in [1, 32767]", count);
  const auto total = static_cast<int64_t>(size);
  require(total % count == 0, argument, "must divide the number of values, " + std::to_string(total), count);
  return total / count;
}

}  // namespace

std::vector<double> power_shares(std::span<const double> power, int64_t num_parts) {
  const int64_t num_cells = cells_of(power.size(), num_parts, "num_parts");
  std::vector<double> share(power.size());
  parallel_for_chunks(num_cells, kCellsPerTask, [&](int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; ++i) {
      double sum = 0.0;
      for (int64_t k = 0; k < num_parts; ++k) sum += power[k * num_cells + i];
      if (sum == 0.0) continue;
      for (int64_t k = 0; k < num_parts; ++k) share[k * num_cells + i] = power[k * num_cells + i] / sum;
    }
  });
  return share;
}

CellMask cell_mask(std::span<const double> power, double noise_floor, double dynamic_range) {
  require(noise_floor >= 0.0, "noise_floor", "must not be negative, in W", noise_floor);
  require(dynamic_range >= 0.0 && dynamic_range <= 1.0, "dynamic_range", "must be in [0, 1]", dynamic_range);
  const double peak = power.empty() ? 0.0 : *std::ranges::max_element(power);
  CellMask mask{std::vector<uint8_t>(power.size()), std::vector<uint8_t>(power.size())};
  for (size_t i = 0; i < power.size(); ++i) {
    mask.above_noise[i] = power[i] > noise_floor;
    mask.labelled[i] = mask.above_noise[i] && power[i] >= dynamic_range * peak;
  }
  return mask;
}

std::vector<int16_t> strongest_part(std::span<const double> power, int64_t num_parts, std::span<const uint8_t> labelled) {
  const int64_t num_cells = cells_of(power.size(), num_parts, "num_parts");
  require(std::ssize(labelled) == num_cells, "labelled",
          "must have one value for each of " + std::to_string(num_cells) + " cells", labelled.size());
  std::vector<int16_t> strongest(num_cells, kNoLabel);
  parallel_for_chunks(num_cells, kCellsPerTask, [&](int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; ++i) {
      double largest = 0.0;
      for (int64_t k = 0; labelled[i] && k < num_parts; ++k) {
        if (power[k * num_cells + i] <= largest) continue;
        largest = power[k * num_cells + i];
        strongest[i] = static_cast<int16_t>(k);
      }
    }
  });
  return strongest;
}

namespace {

void add_cell(LabelRegion& region, int64_t row, int64_t column, double power) {
  const bool first = region.num_cells++ == 0;
  if (first || power > region.peak_power) {
    region.peak_row = row;
    region.peak_column = column;
    region.peak_power = power;
  }
  region.first_column = first ? column : std::min(region.first_column, column);
  region.last_column = first ? column : std::max(region.last_column, column);
}

// Sets the first and last of the occupied rows (ascending, at least one): all of them, or where rows wrap the shortest way
// round.
void set_rows(LabelRegion& region, const std::vector<int64_t>& occupied, const MapShape& shape) {
  region.first_row = occupied.front();
  region.last_row = occupied.back();
  if (!shape.rows_wrap) return;
  int64_t widest = occupied.front() + shape.rows - occupied.back();  // from the last over the end to the first
  for (size_t i = 1; i < occupied.size(); ++i) {
    if (occupied[i] - occupied[i - 1] <= widest) continue;
    widest = occupied[i] - occupied[i - 1];
    region.first_row = occupied[i];
    region.last_row = occupied[i - 1];
  }
}

void check_label_map(std::span<const int16_t> label, std::span<const double> power, int64_t num_labels,
                     const MapShape& shape) {
  const std::string cells = "must have one value for each of " + std::to_string(shape.size()) + " cells";
  require(std::ssize(label) == shape.size(), "label", cells, label.size());
  require(std::ssize(power) == shape.size(), "power", cells, power.size());
  for (const int16_t l : label) require(l >= kNoLabel && l < num_labels, "label", "must be -1 or an index of a label", l);
}

}  // namespace

std::vector<LabelRegion> label_regions(std::span<const int16_t> label, std::span<const double> power, int64_t num_labels,
                                       const MapShape& shape) {
  check_label_map(label, power, num_labels, shape);
  std::vector<LabelRegion> regions(num_labels);
  std::vector<std::vector<int64_t>> occupied(regions.size());
  for (int64_t i = 0; i < shape.size(); ++i) {
    if (label[i] == kNoLabel) continue;
    const auto l = static_cast<size_t>(label[i]);
    const int64_t row = i / shape.columns;
    add_cell(regions[l], row, i % shape.columns, power[i]);
    if (occupied[l].empty() || occupied[l].back() != row) occupied[l].push_back(row);
  }
  for (size_t l = 0; l < regions.size(); ++l) {
    if (!occupied[l].empty()) set_rows(regions[l], occupied[l], shape);
  }
  return regions;
}

}  // namespace echopath
