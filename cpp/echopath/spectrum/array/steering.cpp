#include "echopath/spectrum/array/steering.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "echopath/base/constants.h"
#include "echopath/base/errors.h"

namespace echopath {
namespace {

constexpr double kStepsPerBeam = 4.0;            // per wavelength / extent
constexpr double kLargestElevation = kPi / 4.0;  // of the default grid

void require_axis(const std::vector<double>& axis, const char* name, double limit, const char* rule) {
  require(!axis.empty(), name, "must have at least one angle", axis.size());
  for (size_t i = 0; i < axis.size(); ++i) {
    require(std::abs(axis[i]) <= limit, name, rule, axis[i]);
    require(i == 0 || axis[i] > axis[i - 1], name, "must be ascending", axis[i]);
  }
}

// Returns equal steps about 0 that a grid with `spacing` (0: none) and an aperture `extent` in m can tell apart.
std::vector<double> default_axis(double limit, double spacing, double extent, double wavelength, double largest_step) {
  if (extent < kArrayTolerance * wavelength) return {0.0};
  if (spacing > 0.0) limit = std::min(limit, std::asin(std::min(1.0, 0.5 * wavelength / spacing)));
  const int half = static_cast<int>(std::ceil(limit / std::min(largest_step, wavelength / (kStepsPerBeam * extent))));
  std::vector<double> axis;
  for (int i = -half; i <= half; ++i) axis.push_back(limit * i / half);
  return axis;
}

}  // namespace

Vec3 direction(double azimuth, double elevation) {
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
}

void AngleGrid::validate() const {
  require_axis(azimuth, "azimuth", kPi, "must be in [-pi, pi]");
  require_axis(elevation, "elevation", 0.5 * kPi, "must be in [-pi/2, pi/2]");
}

std::vector<Vec3> AngleGrid::directions() const {
  std::vector<Vec3> units;
  units.reserve(azimuth.size() * elevation.size());
  for (const double up : elevation) {
    for (const double left : azimuth) units.push_back(direction(left, up));
  }
  return units;
}

AngleGrid default_angles(const VirtualArray& array, double largest_step) {
  require(largest_step > 0.0, "largest_step", "must be positive", largest_step);
  const Vec3 extent = array.extent();
  const double column = array.grid ? array.grid->column_spacing : 0.0, row = array.grid ? array.grid->row_spacing : 0.0;
  return {default_axis(0.5 * kPi, column, std::hypot(extent.x(), extent.y()), array.wavelength, largest_step),
          default_axis(kLargestElevation, row, extent.z(), array.wavelength, largest_step)};
}

Eigen::MatrixXcd steering_vectors(const VirtualArray& array, const std::vector<Vec3>& directions) {
  const double wavenumber = kTwoPi / array.wavelength;
  const Vec3 centre = array.centre();
  Eigen::MatrixXcd vectors(array.elements.size(), directions.size());
  for (size_t d = 0; d < directions.size(); ++d) {
    for (size_t e = 0; e < array.elements.size(); ++e) {
      vectors(e, d) = std::polar(1.0, -wavenumber * (array.elements[e].position - centre).dot(directions[d]));
    }
  }
  return vectors;
}

std::vector<double> element_weights(const VirtualArray& array, const Window& window) {
  std::vector<double> weights(array.elements.size(), 1.0);
  if (window.kind != WindowKind::kRect) {
    require(array.grid.has_value(), "window", "must be rect for an array that is no grid of equal steps", "another");
    const auto rows = centred_window_samples(window, array.grid->num_rows);
    const auto columns = centred_window_samples(window, array.grid->num_columns);
    for (size_t e = 0; e < weights.size(); ++e) {
      weights[e] = rows[array.elements[e].row] * columns[array.elements[e].column];
    }
  }
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& weight : weights) weight /= sum;
  return weights;
}

}  // namespace echopath
