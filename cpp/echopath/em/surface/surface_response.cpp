#include "echopath/em/surface/surface_response.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/em/layers/layer_stack.h"
#include "echopath/em/polarization/jones.h"
#include "echopath/em/surface/fresnel.h"

namespace echopath {
namespace {

double other_share(double share) { return std::sqrt(std::max(0.0, 1.0 - share * share)); }

std::complex<double> complex_permittivity(const Material& material, double frequency) {
  const double loss = material.conductivity / (kTwoPi * frequency * kVacuumPermittivity);
  return *material.permittivity - std::complex<double>(0.0, loss);
}

std::shared_ptr<const LayerStack> layers_of(const Material& material, double frequency, SheetSide side) {
  if (!material.is_sheet()) return nullptr;
  std::vector<Layer> layers = material.layers;
  if (side == SheetSide::kBack) std::ranges::reverse(layers);
  return std::make_shared<const LayerStack>(layers, frequency);
}

double facet_reflection(std::complex<double> permittivity) { return std::abs(fresnel_te(permittivity, 1.0)); }

// Returns the coherent field factor of Ament 1953, s = exp(-2 phase^2). `phase` is k sigma_h cos(incidence) in rad, with the
// rms height sigma_h.
double ament_of_phase(double phase) { return std::exp(-2.0 * phase * phase); }

}  // namespace

SurfaceModel::SurfaceModel(const Material& material, double frequency, SheetSide side)
    : material_(&material), lobe_(material), is_dielectric_(!material.conductor && !material.reflectivity),
      layers_(layers_of(material, frequency, side)) {
  constant_.gamma = material.reflectivity ? -std::sqrt(*material.reflectivity) : -1.0;
  if (material.permittivity) permittivity_ = complex_permittivity(material, frequency);
  constant_.facet = is_dielectric_ ? facet_reflection(permittivity_) : std::abs(constant_.gamma);
  if (layers_) constant_.facet = std::abs(layers_->reflection(1.0).te);
  if (material.scattering) {
    constant_.diffuse = *material.scattering;
    constant_.coherent = other_share(constant_.diffuse);
  } else {
    wavenumber_height_ = kTwoPi * frequency / kSpeedOfLight * material.roughness_height;
  }
}

SurfaceResponse SurfaceModel::respond_at(double cos_incidence, PolarizationMode mode) const {
  SurfaceResponse response = constant_;
  if (is_dielectric_) {
    const bool is_te = mode == PolarizationMode::kTe;
    if (layers_) response.gamma = is_te ? layers_->reflection(cos_incidence).te : layers_->reflection(cos_incidence).tm;
    else response.gamma = is_te ? fresnel_te(permittivity_, cos_incidence) : fresnel_tm(permittivity_, cos_incidence);
  }
  if (wavenumber_height_ > 0) {
    response.coherent = ament_of_phase(wavenumber_height_ * cos_incidence);
    response.diffuse = other_share(response.coherent);
  }
  return response;
}

// The TM coefficient of a conductor is +1 for field vectors.
ModeCoefficients SurfaceModel::modes(double cos_incidence) const {
  if (!is_dielectric_) return {constant_.gamma, -constant_.gamma};
  const FresnelModes found = layers_ ? layers_->reflection(cos_incidence) : fresnel_modes(permittivity_, cos_incidence);
  return {found.te, found.tm};
}

SurfaceResponse respond(const Material& material, double frequency, double cos_incidence, PolarizationMode mode) {
  return SurfaceModel(material, frequency).respond(cos_incidence, mode);
}

}  // namespace echopath
