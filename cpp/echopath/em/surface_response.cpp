#include "echopath/em/surface_response.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/em/fresnel.h"

namespace echopath {
namespace {

std::complex<double> reflection(const Material& material, double frequency, double cos_incidence, PolarizationMode mode) {
  if (material.conductor) return -1.0;
  if (material.reflectivity) return -std::sqrt(*material.reflectivity);
  const double loss = material.conductivity / (kTwoPi * frequency * kVacuumPermittivity);
  const std::complex<double> permittivity = *material.permittivity - std::complex<double>(0.0, loss);
  return mode == PolarizationMode::kTe ? fresnel_te(permittivity, cos_incidence) : fresnel_tm(permittivity, cos_incidence);
}

}  // namespace

double ament_factor(double wavenumber, double roughness_height, double cos_incidence) {
  const double phase = wavenumber * roughness_height * cos_incidence;
  return std::exp(-2.0 * phase * phase);
}

SurfaceResponse respond(const Material& material, double frequency, double cos_incidence, PolarizationMode mode) {
  SurfaceResponse response;
  response.gamma = reflection(material, frequency, cos_incidence, mode);
  if (material.scattering) {
    response.diffuse = *material.scattering;
    response.coherent = std::sqrt(std::max(0.0, 1.0 - response.diffuse * response.diffuse));
  } else if (material.roughness_height > 0) {
    response.coherent = ament_factor(kTwoPi * frequency / kSpeedOfLight, material.roughness_height, cos_incidence);
    response.diffuse = std::sqrt(std::max(0.0, 1.0 - response.coherent * response.coherent));
  }
  return response;
}

}  // namespace echopath
