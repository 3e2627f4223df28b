#pragma once
// Computes the reflection and transmission of a plane wave at a stack of flat layers in air, with the time factor e^{+jwt}.
//
// Layers are joined from behind, each with Airy's sum over the bounces within it: a stack behind a layer is one interface of
// known reflection and transmission. Only decaying exponentials occur, so that thick and lossy layers lose no digits.
// Sources: Airy 1833; Yeh 1988, "Optical Waves in Layered Media", chapter 4 (recursion of Rouard).
#include <complex>
#include <span>
#include <vector>

#include "echopath/em/material.h"
#include "echopath/em/surface/fresnel.h"

namespace echopath {

// Holds the field transmission of both modes.
struct LayerTransmission {
  std::complex<double> te, tm;
};

// Holds phases in rad of the transmission of both modes, without jumps over frequency: many turns in thick layers.
struct LayerPhases {
  double te = 0.0, tm = 0.0;
};

class LayerStack {
 public:
  // Takes the layers in the order in which the wave meets them; `frequency` is in Hz.
  LayerStack(std::span<const Layer> layers, double frequency);
  // Returns the reflection at the first face, in the signs of fresnel_te and fresnel_tm; cos_incidence in [0, 1] is taken
  // from the normal.
  FresnelModes reflection(double cos_incidence) const;
  // Returns the field behind the last face over that before the first one, at the points where a normal meets both.
  LayerTransmission transmission(double cos_incidence) const;
  // Returns the same over that of free space between the same faces: over the phase of the straight line. Writes its phases,
  // whose difference between two frequencies counts whole turns, too, to `phases`, unless it is null.
  LayerTransmission over_free_space(double cos_incidence, LayerPhases* phases = nullptr) const;
  // Returns by how much a ray leaves the stack beside the straight line, in m across the ray: the sum of what its layers
  // refract. It is positive toward the foot of the normal at the point of entry.
  double offset(double cos_incidence) const;
  // Returns the phase in rad of a wave that runs to and fro within all layers at normal incidence.
  double most_phase() const;

 private:
  struct Slice {
    std::complex<double> permittivity;
    double phase;  // rad, wavenumber of free space times the thickness
  };
  struct Joined {
    FresnelModes reflection;
    LayerTransmission transmission;
  };
  // Adds the phases of the transmission to `phases`, unless it is null.
  Joined joined(double cos_incidence, LayerPhases* phases = nullptr) const;

  std::vector<Slice> slices_;
  double phase_ = 0.0, wavenumber_;
};

}  // namespace echopath
