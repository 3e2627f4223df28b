#pragma once
// Computes what a material makes of a wave at one hit: its reflection coefficients and the split into coherent and diffuse
// power.
//
// The mirrored part takes Fresnel's coefficient of the mean surface. The scattered part comes from facets: those that send
// power back toward the radar face it, whatever the mean surface's angle, so that a rough dielectric scatters with the power
// reflectivity of normal incidence in both polarisations. Brewster's angle belongs to the mean surface alone. The reflected
// share of power, s^2 |gamma|^2 + S^2 facet^2, is at most 1 at every angle and in either polarisation. A facet that scatters
// toward another direction sees half the angle between both directions: below 45 degrees its reflectivity, averaged over
// polarisations, stays within half a decibel; beyond it grows, so that the model understates what a road scatters forward at
// grazing incidence.
// Sources: Kirchhoff's approximation in its limit of geometrical optics (Ulaby, Moore, Fung 1982, volume 2, chapter 12): the
// coefficient is that of the facet that mirrors one direction into the other, at normal incidence for backscatter.
#include <complex>
#include <memory>

#include "echopath/em/surface/diffuse_lobe.h"

namespace echopath {

enum class PolarizationMode { kTe, kTm };

struct SurfaceResponse {
  std::complex<double> gamma;  // field reflection coefficient of the mean surface
  double coherent = 1.0;       // s: field share of the specular part, s^2 + S^2 = 1
  double diffuse = 0.0;        // S: square root of the diffuse share of power
  double facet = 1.0;          // magnitude of the field reflection of the facets that scatter
};

// Returns the response at `frequency` [Hz] and cos_incidence in [0, 1]. A conductor reflects with -1 in both modes (scalar
// convention), a constant reflectivity rho with -sqrt(rho).
SurfaceResponse respond(const Material& material, double frequency, double cos_incidence, PolarizationMode mode);

struct ModeCoefficients;  // em/polarization/jones.h
class LayerStack;         // em/layers/layer_stack.h

// Names the side from which a wave meets a sheet: kFront is that of the surface's normals.
enum class SheetSide { kFront, kBack };

// Models a material at one frequency and works out once what does not depend on the wave. `material` must outlive it.
class SurfaceModel {
 public:
  SurfaceModel(const Material& material, double frequency, SheetSide side = SheetSide::kFront);
  const Material& material() const { return *material_; }
  const DiffuseLobe& lobe() const { return lobe_; }
  // Returns whether the coefficients depend on the polarisation.
  bool is_dielectric() const { return is_dielectric_; }
  // Returns whether the response is the same for all waves.
  bool is_constant() const { return !is_dielectric_ && wavenumber_height_ == 0; }
  // Returns whether a part of the power may leave diffusely.
  bool may_scatter() const { return constant_.diffuse > 0 || wavenumber_height_ > 0; }
  // Returns the same as the free function `respond`.
  SurfaceResponse respond(double cos_incidence, PolarizationMode mode) const {
    return is_constant() ? constant_ : respond_at(cos_incidence, mode);
  }
  // Returns the coefficients of both modes, for field vectors.
  ModeCoefficients modes(double cos_incidence) const;

 private:
  SurfaceResponse respond_at(double cos_incidence, PolarizationMode mode) const;

  const Material* material_;
  DiffuseLobe lobe_;
  SurfaceResponse constant_;  // the part that does not depend on the wave
  bool is_dielectric_;
  std::complex<double> permittivity_ = 1.0;   // relative, with the conductivity
  std::shared_ptr<const LayerStack> layers_;  // of a sheet, as the wave meets them
  double wavenumber_height_ = 0.0;            // rad, k sigma_h; 0 for a smooth surface or a constant share that scatters
};

}  // namespace echopath
