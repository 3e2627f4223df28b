#pragma once
// Defines directions, and the plane waves from them at the elements of a virtual array.
#include <Eigen/Core>
#include <vector>

#include "echopath/base/constants.h"
#include "echopath/spectrum/array/virtual_array.h"
#include "echopath/spectrum/window.h"

namespace echopath {

// Holds directions in the radar's frame: azimuth about z from +x to the left (+y), elevation up from the xy-plane.
struct AngleGrid {
  std::vector<double> azimuth;    // [A] rad, ascending, in [-2 pi, 2 pi]
  std::vector<double> elevation;  // [E] rad, ascending, in [-pi/2, pi/2]

  void validate() const;                 // raises invalid_argument naming the field, the rule and the value
  std::vector<Vec3> directions() const;  // [E, A] unit vectors
};

inline constexpr double kTellingExtent = 0.1;  // wavelengths; directions of less differ by less than the noise of an echo

Vec3 direction(double azimuth, double elevation);  // rad -> unit vector

// Return the angles in rad that an array tells apart: azimuths up to +-90 degrees about the direction across the array, on
// the side to which its antennas look, and elevations up to +-45 degrees, within the unambiguous field wavelength / (2
// spacing) of its grid, in steps of a quarter of wavelength / extent, or of `largest_step` rad where that is less; only one
// where the array does not tell them. Raise invalid_argument where there would be more than 200,000.
inline constexpr double kPictureStep = kPi / 180.0;
std::vector<double> default_azimuths(const VirtualArray& array, double largest_step = kPictureStep);
std::vector<double> default_elevations(const VirtualArray& array, double largest_step = kPictureStep);
bool has_default_azimuths(const VirtualArray& array, double largest_step = kPictureStep);  // whether there are so few
// Tell whether the array has a horizontal or a vertical extent of a tenth of a wavelength. An array on one line, inclined or
// not, tells only one of these angles: that of its larger extent.
bool tells_azimuths(const VirtualArray& array);
bool tells_elevations(const VirtualArray& array);

// Returns e^{-j k (x - centre).u} [elements, directions], for the far field, exact positions and the centre frequency's
// wavelength.
Eigen::MatrixXcd steering_vectors(const VirtualArray& array, const std::vector<Vec3>& directions);
// Returns the directions of a grid, for beams of an array. Raises invalid_argument where elements times directions pass
// 2^27.
std::vector<Vec3> beam_directions(const VirtualArray& array, const AngleGrid& angles);

// Returns weights [elements] of a window over the rows and the columns of the array's grid, whose sum is 1. Here windows are
// symmetric and nowhere zero: cosines are sampled half-way between the steps.
// Raises invalid_argument for windows other than rect without a grid.
std::vector<double> element_weights(const VirtualArray& array, const Window& window);

}  // namespace echopath
