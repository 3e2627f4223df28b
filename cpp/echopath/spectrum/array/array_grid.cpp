#include "echopath/spectrum/array/array_grid.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>

namespace echopath {
namespace {

constexpr int kMaxPointsPerElement = 16;
constexpr size_t kMaxCandidates = 64;  // axes tried where the horizontal and the upward one do not fit

// Describes points along one axis as whole steps: coordinate = offset + index * spacing.
struct Steps {
  std::vector<int> index;  // [N]
  double spacing = 0.0, offset = 0.0, deviation = 0.0;
  int count = 1;
};

std::vector<double> distinct(std::vector<double> values, double tolerance) {
  std::ranges::sort(values);
  const auto is_same = [tolerance](double a, double b) { return b - a <= tolerance; };
  values.erase(std::unique(values.begin(), values.end(), is_same), values.end());
  return values;
}

// Returns the step near `spacing` of which the ascending distances from the first value are whole multiples. Each distance
// that is counted makes the step more precise for the next.
double refined_spacing(const std::vector<double>& ascending, double spacing) {
  double products = 0.0, squares = 0.0;
  for (const double value : ascending) {
    const double distance = value - ascending.front(), steps = std::round(distance / spacing);
    products += steps * distance;
    squares += steps * steps;
    if (squares > 0.0) spacing = products / squares;
  }
  return spacing;
}

Steps in_steps(const std::vector<double>& coordinate, double first, double spacing) {
  Steps steps;
  steps.spacing = spacing;
  for (const double value : coordinate) {
    steps.index.push_back(static_cast<int>(std::lround((value - first) / spacing)));
    steps.offset += (value - steps.index.back() * spacing) / static_cast<double>(coordinate.size());
  }
  for (size_t i = 0; i < coordinate.size(); ++i) {
    const double error = coordinate[i] - steps.offset - steps.index[i] * spacing;
    steps.deviation = std::max(steps.deviation, std::abs(error));
  }
  steps.count = *std::ranges::max_element(steps.index) + 1;
  return steps;
}

// Returns the largest step that fits: the smallest difference of two coordinates, or a whole part of it.
std::optional<Steps> fit_steps(const std::vector<double>& coordinate, double tolerance, double min_spacing) {
  const std::vector<double> levels = distinct(coordinate, tolerance);
  if (levels.size() == 1) return Steps{std::vector<int>(coordinate.size()), 0.0, levels[0], 0.0, 1};
  double gap = levels.back() - levels.front();
  for (size_t i = 1; i < levels.size(); ++i) gap = std::min(gap, levels[i] - levels[i - 1]);
  for (int parts = 1; gap / parts >= min_spacing; ++parts) {
    const Steps steps = in_steps(coordinate, levels.front(), refined_spacing(levels, gap / parts));
    if (steps.count > kMaxPointsPerElement * static_cast<int>(levels.size())) return std::nullopt;
    if (steps.deviation <= tolerance) return steps;
  }
  return std::nullopt;
}

std::vector<double> along(const std::vector<Vec3>& points, const Vec3& axis) {
  std::vector<double> coordinate;
  for (const Vec3& point : points) coordinate.push_back(point.dot(axis));
  return coordinate;
}

// Returns the axis or its opposite, so that the first component in this order that is not zero is positive.
Vec3 oriented(const Vec3& axis, std::initializer_list<int> order) {
  constexpr double kAlong = 1e-9;
  for (const int k : order) {
    if (std::abs(axis[k]) > kAlong) return axis[k] > 0.0 ? axis : Vec3(-axis);
  }
  return axis;
}
Vec3 to_the_left(const Vec3& axis) { return oriented(axis, {1, 0, 2}); }
Vec3 upwards(const Vec3& axis) { return oriented(axis, {2, 0, 1}); }

// Returns a horizontal unit vector perpendicular to `axis`, +y for an upright one.
Vec3 horizontal_normal(const Vec3& axis) {
  const Vec3 normal = Vec3::UnitZ().cross(axis);
  constexpr double kUpright = 0.01;
  return normal.norm() > kUpright ? Vec3(normal.normalized()) : Vec3(Vec3::UnitY());
}

std::optional<GridFit> fit_axes(const std::vector<Vec3>& points, const Vec3& column_axis, const Vec3& row_axis,
                                double tolerance, double min_spacing) {
  const auto columns = fit_steps(along(points, column_axis), tolerance, min_spacing);
  if (!columns) return std::nullopt;
  const auto rows = fit_steps(along(points, row_axis), tolerance, min_spacing);
  if (!rows) return std::nullopt;
  GridFit fit{{}, rows->index, columns->index};
  fit.grid = {rows->count, columns->count, column_axis, row_axis, columns->spacing, rows->spacing, Vec3::Zero(), 0.0};
  const Vec3 normal = column_axis.cross(row_axis);
  for (const Vec3& point : points) fit.grid.origin += normal.dot(point) * normal / static_cast<double>(points.size());
  fit.grid.origin += columns->offset * column_axis + rows->offset * row_axis;
  for (size_t i = 0; i < points.size(); ++i) {
    const Vec3 on_grid =
        fit.grid.origin + columns->index[i] * columns->spacing * column_axis + rows->index[i] * rows->spacing * row_axis;
    fit.grid.deviation = std::max(fit.grid.deviation, (points[i] - on_grid).norm());
  }
  return fit;
}

// Fits an axis in the plane of `normal` and the one perpendicular to it, the more horizontal first.
std::optional<GridFit> fit_plane(const std::vector<Vec3>& points, const Vec3& axis, const Vec3& normal, double tolerance,
                                 double min_spacing) {
  const Vec3 other = normal.cross(axis);
  const bool is_upright = std::abs(axis.z()) > std::abs(other.z());
  return fit_axes(points, to_the_left(is_upright ? other : axis), upwards(is_upright ? axis : other), tolerance,
                  min_spacing);
}

std::optional<GridFit> fit_line(const std::vector<Vec3>& points, const Vec3& axis, double tolerance, double min_spacing) {
  const Vec3 across = horizontal_normal(axis);
  if (axis.z() * axis.z() > 0.5) return fit_axes(points, to_the_left(across), upwards(axis), tolerance, min_spacing);
  return fit_axes(points, to_the_left(axis), upwards(axis.cross(across)), tolerance, min_spacing);
}

Vec3 farthest(const std::vector<Vec3>& offsets) {
  return *std::ranges::max_element(offsets, {}, [](const Vec3& offset) { return offset.squaredNorm(); });
}

// Returns the parts of the offsets perpendicular to a unit vector.
std::vector<Vec3> perpendicular(const std::vector<Vec3>& offsets, const Vec3& axis) {
  std::vector<Vec3> parts;
  for (const Vec3& offset : offsets) parts.push_back(offset - axis.dot(offset) * axis);
  return parts;
}

// Tries the axes from the first point to the nearest others and takes the one whose grid has the fewest points.
std::optional<GridFit> fit_some_axis(const std::vector<Vec3>& points, std::vector<Vec3> offsets, const Vec3& normal,
                                     double tolerance, double min_spacing) {
  const auto is_shorter = [](const Vec3& a, const Vec3& b) { return a.squaredNorm() < b.squaredNorm(); };
  std::ranges::stable_sort(offsets, is_shorter);  // the first is zero
  offsets.resize(std::min(offsets.size(), kMaxCandidates + 1));
  std::optional<GridFit> best;
  const auto num_points = [](const GridFit& fit) { return int64_t{fit.grid.num_rows} * fit.grid.num_columns; };
  for (const Vec3& axis : perpendicular({offsets.begin() + 1, offsets.end()}, normal)) {
    auto fit = fit_plane(points, axis.normalized(), normal, tolerance, min_spacing);
    if (fit && (!best || num_points(*fit) < num_points(*best))) best = std::move(fit);
  }
  return best;
}

}  // namespace

std::optional<GridFit> fit_grid(const std::vector<Vec3>& points, double tolerance, double min_spacing) {
  std::vector<Vec3> offsets;
  for (const Vec3& point : points) offsets.push_back(point - points.front());
  if (points.size() == 1) return fit_axes(points, Vec3::UnitY(), Vec3::UnitZ(), tolerance, min_spacing);
  const Vec3 axis = farthest(offsets).normalized();
  const std::vector<Vec3> beside = perpendicular(offsets, axis);
  const Vec3 off_line = farthest(beside);
  if (off_line.norm() <= tolerance) return fit_line(points, axis, tolerance, min_spacing);
  const Vec3 normal = axis.cross(off_line.normalized());
  for (const Vec3& offset : offsets) {
    if (std::abs(normal.dot(offset)) > tolerance) return std::nullopt;
  }
  if (auto fit = fit_plane(points, horizontal_normal(normal), normal, tolerance, min_spacing)) return fit;
  return fit_some_axis(points, offsets, normal, tolerance, min_spacing);
}

}  // namespace echopath
