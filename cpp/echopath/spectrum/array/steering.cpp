#include "echopath/spectrum/array/steering.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "echopath/base/constants.h"
#include "echopath/base/errors.h"
#include "echopath/base/principal_box.h"

namespace echopath {
namespace {

constexpr double kStepsPerBeam = 4.0;            // per wavelength / extent
constexpr double kLargestElevation = kPi / 4.0;  // of the default grid
constexpr double kEndfire = 0.1;                 // sine between an array's line and the boresights along it
constexpr double kAligned = 0.01;                // rad, off the direction across its line: antennas that look that way
constexpr double kMostSteps = 1e5;               // of a default axis, to either side
constexpr double kMostTerms = 134217728.0;       // of steering vectors: 2 GiB

void require_axis(const std::vector<double>& axis, const char* name, double limit, const char* rule) {
  require(!axis.empty(), name, "must have at least one angle", axis.size());
  for (size_t i = 0; i < axis.size(); ++i) {
    require(std::abs(axis[i]) <= limit, name, rule, axis[i]);
    require(i == 0 || axis[i] > axis[i - 1], name, "must be ascending", axis[i]);
  }
}

bool tells_apart(double extent, double wavelength) { return extent >= kTellingExtent * wavelength; }

double width_of(const VirtualArray& array) { return std::hypot(array.extent().x(), array.extent().y()); }

// Returns whether all positions lie on a line, inclined or not. Such an array tells one angle only, that off its line: all
// directions of a cone about it have the same phases.
bool is_line(const VirtualArray& array) {
  return !tells_apart(principal_box(array.positions).box.sizes()[1], array.wavelength);
}

bool is_upright(const VirtualArray& array) { return array.extent().z() > width_of(array); }

// Returns the azimuth in rad about which directions differ most: that of the boresights, or for an array that is a line from
// above the one across it on their side, because such an array cannot tell one side from the other.
double middle_azimuth(const VirtualArray& array) {
  std::vector<Vec3> from_above = array.positions;
  for (Vec3& position : from_above) position.z() = 0.0;
  const PrincipalBox line = principal_box(from_above);
  if (!tells_azimuths(array) || tells_apart(line.box.sizes()[1], array.wavelength)) return array.boresight;
  const Vec3 left = Vec3::UnitZ().cross(line.axes.col(2));
  const double sine = left.dot(direction(array.boresight, 0.0));
  if (std::abs(sine) < kEndfire || std::abs(sine) > std::cos(kAligned)) return array.boresight;
  const Vec3 across = std::copysign(1.0, sine) * left;
  return std::atan2(across.y(), across.x());
}

// Holds the equal steps about a middle that a grid of antennas can tell apart along one axis.
struct DefaultAxis {
  double limit;  // rad, angle of the last step
  double steps;  // to either side, maybe more than there may be; 0 where the array has no extent
};

// Works them out for a grid with `spacing` (0: none) and an aperture `extent` in m.
DefaultAxis default_axis(double limit, double spacing, double extent, double wavelength, double largest_step) {
  if (spacing > 0.0) limit = std::min(limit, std::asin(std::min(1.0, 0.5 * wavelength / spacing)));
  return {limit, std::ceil(limit / std::min(largest_step, wavelength / (kStepsPerBeam * extent)))};
}

DefaultAxis azimuth_axis(const VirtualArray& array, double largest_step) {
  require(largest_step > 0.0, "largest_step", "must be positive", largest_step);
  if (!tells_azimuths(array)) return {0.0, 0.0};
  const double spacing = array.grid ? array.grid->column_spacing : 0.0;
  return default_axis(0.5 * kPi, spacing, width_of(array), array.wavelength, largest_step);
}

DefaultAxis elevation_axis(const VirtualArray& array, double largest_step) {
  require(largest_step > 0.0, "largest_step", "must be positive", largest_step);
  if (!tells_elevations(array)) return {0.0, 0.0};
  const double spacing = array.grid ? array.grid->row_spacing : 0.0;
  return default_axis(kLargestElevation, spacing, array.extent().z(), array.wavelength, largest_step);
}

std::vector<double> angles_of(const DefaultAxis& axis, double middle, const char* name, double extent) {
  require(axis.steps <= kMostSteps, name, "must be given: an array of this length in m tells more than 200,000 angles apart",
          extent);
  const int half = static_cast<int>(axis.steps);
  if (half == 0) return {middle};
  std::vector<double> angles;
  for (int i = -half; i <= half; ++i) angles.push_back(middle + axis.limit * i / half);
  return angles;
}

}  // namespace

Vec3 direction(double azimuth, double elevation) {
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
}

void AngleGrid::validate() const {
  require_axis(azimuth, "azimuth", kTwoPi, "must be in [-2 pi, 2 pi]");
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

bool tells_azimuths(const VirtualArray& array) {
  return tells_apart(width_of(array), array.wavelength) && !(is_upright(array) && is_line(array));
}

bool tells_elevations(const VirtualArray& array) {
  return tells_apart(array.extent().z(), array.wavelength) && (is_upright(array) || !is_line(array));
}

bool has_default_azimuths(const VirtualArray& array, double largest_step) {
  return azimuth_axis(array, largest_step).steps <= kMostSteps;
}

std::vector<double> default_azimuths(const VirtualArray& array, double largest_step) {
  return angles_of(azimuth_axis(array, largest_step), middle_azimuth(array), "azimuth", width_of(array));
}

std::vector<double> default_elevations(const VirtualArray& array, double largest_step) {
  return angles_of(elevation_axis(array, largest_step), 0.0, "elevation", array.extent().z());
}

std::vector<Vec3> beam_directions(const VirtualArray& array, const AngleGrid& angles) {
  const double terms = static_cast<double>(array.elements.size()) * static_cast<double>(angles.azimuth.size()) *
                       static_cast<double>(angles.elevation.size());
  require(terms <= kMostTerms, "azimuth, elevation", "must have at most 134,217,728 directions times elements of the array",
          terms);
  return angles.directions();
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
    require(array.grid.has_value(), "window", "must be rect for an array that is no grid of equal steps", window.name());
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
