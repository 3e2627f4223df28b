#include "echopath/spectrum/array/covering_directions.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/errors.h"
#include "echopath/spectrum/array/steering.h"

namespace echopath {
namespace {

constexpr int kStepsPerWidth = 2;
constexpr double kMostBeams = 131072.0;

// Holds direction cosines along one axis, in equal steps.
struct Cosines {
  Vec3 axis;
  double step = 0.0;  // 0: one cosine, for an array that tells none along the axis
  int first = 0, last = 0;

  double at(int index) const { return index * step; }
  int64_t count() const { return last - first + 1; }
};

// Returns the cosines of a transform of twice as many points as the grid has along the axis.
Cosines grid_cosines(const Vec3& axis, int num_points, double spacing) {
  if (num_points == 1) return {axis};
  const double step = 1.0 / (kStepsPerWidth * num_points * spacing);
  const int half = kStepsPerWidth * num_points / 2;
  return {axis, step, -half, half - 1};
}

Cosines free_cosines(const VirtualArray& array, const Vec3& axis) {
  double low = 0.0, high = 0.0;
  for (const Vec3& position : array.positions) {
    const double place = (position - array.positions.front()).dot(axis);
    low = std::min(low, place), high = std::max(high, place);
  }
  const double extent = (high - low) / array.wavelength;
  if (extent < kTellingExtent) return {axis};
  const double half = std::min(std::ceil(kStepsPerWidth * (extent + 0.5)), kMostBeams);
  return {axis, 1.0 / half, -static_cast<int>(half), static_cast<int>(half)};
}

// Returns the part of a direction across both axes, 0 beyond the circle of waves.
double across(double column, double row) { return std::sqrt(std::max(0.0, 1.0 - column * column - row * row)); }

// Returns whether a step about a pair of cosines holds a direction that waves come from.
bool is_seen(double column, double column_step, double row, double row_step) {
  return std::hypot(std::max(0.0, std::abs(column) - 0.5 * column_step), std::max(0.0, std::abs(row) - 0.5 * row_step)) <=
         1.0;
}

}  // namespace

std::vector<Vec3> covering_directions(const VirtualArray& array) {
  const auto& grid = array.grid;
  const Vec3 ahead = direction(array.boresight, 0.0);
  const Cosines columns = grid ? grid_cosines(grid->column_axis, grid->num_columns, grid->column_spacing / array.wavelength)
                               : free_cosines(array, Vec3::UnitZ().cross(ahead));
  const Cosines rows = grid ? grid_cosines(grid->row_axis, grid->num_rows, grid->row_spacing / array.wavelength)
                            : free_cosines(array, Vec3::UnitZ());
  const double count = static_cast<double>(columns.count()) * static_cast<double>(rows.count());
  require(count <= kMostBeams, "radar", "must have an array of at most 131,072 beams to test cells in all of them", count);
  std::vector<Vec3> directions;
  for (int r = rows.first; r <= rows.last; ++r) {
    for (int c = columns.first; c <= columns.last; ++c) {
      const double column = columns.at(c), row = rows.at(r);
      if (!is_seen(column, columns.step, row, rows.step)) continue;
      directions.push_back(column * columns.axis + row * rows.axis + (grid ? 0.0 : across(column, row)) * ahead);
    }
  }
  return directions;
}

}  // namespace echopath
