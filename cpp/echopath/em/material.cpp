#include "echopath/em/material.h"

#include <cmath>

#include "echopath/base/errors.h"
#include "echopath/base/text/streamed.h"

namespace echopath {
namespace {

constexpr size_t kMostLayers = 64;
// Bounds permittivities and conductivities in S/m, far beyond all matter: their squares are finite.
constexpr double kLargest = 1e100;

void validate_permittivity(const std::complex<double>& permittivity) {
  require(std::isfinite(permittivity.real()) && std::isfinite(permittivity.imag()), "permittivity", "must be finite",
          permittivity);
  require(permittivity.imag() <= 0, "permittivity", "is eps' - j eps'': its imaginary part must not be positive",
          permittivity);
  require(permittivity != std::complex<double>(0.0, 0.0), "permittivity", "must not be 0", permittivity);
  const double size = std::abs(permittivity);
  require(size >= 1.0 / kLargest && size <= kLargest, "permittivity", "must be from 1e-100 to 1e100 in size", permittivity);
}

void validate_conductivity(double conductivity) {
  require(std::isfinite(conductivity) && conductivity >= 0, "conductivity", "must be >= 0 S/m", conductivity);
  require(conductivity <= kLargest, "conductivity", "must be at most 1e100 S/m; conductor=True is without bounds",
          conductivity);
}

void validate_layers(const Material& material) {
  require(material.layers.size() <= kMostLayers, "layers", "must be at most 64", material.layers.size());
  for (const Layer& layer : material.layers) {
    require(std::isfinite(layer.thickness) && layer.thickness > 0, "thickness", "of a layer must be > 0 m", layer.thickness);
    validate_permittivity(layer.permittivity);
    validate_conductivity(layer.conductivity);
  }
  if (!material.is_sheet() || !material.mirror) return;
  constexpr const char* kRule =
      "must be False where a material has layers, as flagged mirrors let nothing pass; materials without layers do: 'glass' "
      "in the place of 'glass_pane', 'plasterboard' in that of 'plasterboard_wall'";
  double thickness = 0.0;
  for (const Layer& layer : material.layers) thickness += layer.thickness;
  require(false, "mirror", kRule, streamed("True of ", 1e3 * thickness, " mm of layers"));
}

}  // namespace

Material Material::metal(bool mirror) {
  Material material;
  material.conductor = true;
  material.mirror = mirror;
  return material;
}

void Material::validate() const {
  const int kinds = (conductor ? 1 : 0) + (permittivity ? 1 : 0) + (reflectivity ? 1 : 0) + (is_sheet() ? 1 : 0);
  require(kinds == 1, "material", "takes exactly one of conductor, permittivity, reflectivity, layers", kinds);
  if (permittivity) validate_permittivity(*permittivity);
  validate_layers(*this);
  validate_conductivity(conductivity);
  require(conductivity == 0 || permittivity.has_value(), "conductivity", "needs a permittivity", conductivity);
  if (reflectivity) require(*reflectivity >= 0 && *reflectivity <= 1, "reflectivity", "must lie in [0, 1]", *reflectivity);
  require(std::isfinite(roughness_height) && roughness_height >= 0, "roughness_height", "must be >= 0 m", roughness_height);
  if (scattering) {
    require(*scattering >= 0 && *scattering <= 1, "scattering", "must lie in [0, 1]", *scattering);
    require(roughness_height == 0, "roughness_height", "excludes scattering: give one of them", roughness_height);
  }
  require(cross_polarization >= 0 && cross_polarization <= 0.5, "cross_polarization",
          "must lie in [0, 0.5], where one half is full depolarisation", cross_polarization);
  validate_lobe();
}

void Material::validate_lobe() const {
  const auto is_exponent = [](int exponent) { return exponent >= 0 && exponent <= kMostLobeExponent; };
  require(is_exponent(lobe_exponent), "lobe_exponent", "must lie in 0 to 100; 0 is Lambert's lobe", lobe_exponent);
  require(backscatter_share >= 0 && backscatter_share <= 1, "backscatter_share", "must lie in [0, 1]", backscatter_share);
  require(backscatter_share == 0 || lobe_exponent > 0, "backscatter_share", "needs a lobe_exponent", backscatter_share);
  require(is_exponent(backscatter_exponent), "backscatter_exponent", "must lie in 0 to 100; 0 stands for lobe_exponent",
          backscatter_exponent);
  require(backscatter_exponent == 0 || backscatter_share > 0, "backscatter_exponent", "needs a backscatter_share",
          backscatter_exponent);
}

}  // namespace echopath
