#pragma once
// A material says what a surface does to a wave.
#include <complex>
#include <optional>
#include <vector>

namespace echopath {

// Describes one layer of a sheet.
struct Layer {
  double thickness = 0.0;                   // m
  std::complex<double> permittivity = 1.0;  // relative, eps' - j eps'', imaginary part <= 0
  double conductivity = 0.0;                // S/m, adds -j sigma/(w eps0)

  bool operator==(const Layer&) const = default;
};

// Takes exactly one of conductor, permittivity, reflectivity, layers, and at most one of roughness_height, scattering.
struct Material {
  bool conductor = false;                            // perfect conductor
  std::optional<std::complex<double>> permittivity;  // relative, eps' - j eps'', imaginary part <= 0
  double conductivity = 0.0;                         // S/m, adds -j sigma/(w eps0)
  std::optional<double> reflectivity;  // power reflectivity in [0, 1] at every angle (reflects like a conductor)
  // These are the layers of a sheet in air, through which waves pass (em/layers/layer_stack.h), from the side of the
  // surface's normals on. The surface is the face that the wave meets first.
  std::vector<Layer> layers;
  double roughness_height = 0.0;     // rms height in m (Ament)
  std::optional<double> scattering;  // S in [0, 1], S^2 is the diffuse share of power (Degli-Esposti 2007)
  double cross_polarization = 0.0;   // in [0, 0.5], share of diffuse power in the cross polarisation
  // These describe the lobe of the scattered power (em/surface/diffuse_lobe.h): the exponent of a directive lobe, 0 for
  // Lambert's; the share in [0, 1] of a directive lobe that goes back to where the wave comes from; and the exponent of that
  // part, 0 for the exponent of the other. Exponents are at most kMostLobeExponent.
  int lobe_exponent = 0;
  double backscatter_share = 0.0;
  int backscatter_exponent = 0;
  bool mirror = false;  // a plane larger than its Fresnel zone, treated by images

  static constexpr int kMostLobeExponent = 100;

  static Material metal(bool mirror = false);
  bool is_sheet() const { return !layers.empty(); }
  // Raises invalid_argument naming the field, the rule and the value.
  void validate() const;

 private:
  void validate_lobe() const;
};

}  // namespace echopath
