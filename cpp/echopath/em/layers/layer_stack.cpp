#include "echopath/em/layers/layer_stack.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"

namespace echopath {
namespace {

using Complex = std::complex<double>;

// Holds a half space as seen by a wave: its permittivity and the cosine of its direction there times the refractive index.
struct Side {
  Complex permittivity, cosine;
};

struct Interface {
  Complex te, tm;
};

Interface reflection_between(const Side& before, const Side& behind) {
  const Complex tm_before = behind.permittivity * before.cosine, tm_behind = before.permittivity * behind.cosine;
  return {(before.cosine - behind.cosine) / (before.cosine + behind.cosine),
          (tm_before - tm_behind) / (tm_before + tm_behind)};
}

// Puts an interface and a layer before what is known of the stack behind them. Adds the phase of the interface and of the
// bounces within to `phase`, unless it is null. Nothing passive reflects more than it gets: 1 + interface and the sum have
// positive real parts, so that the argument of their quotient never jumps.
void join(Complex interface, Complex through, Complex& reflection, Complex& transmission, double* phase) {
  const Complex back = reflection * through * through, sum = 1.0 + interface * back;
  transmission *= (1.0 + interface) * through / sum;
  reflection = (interface + back) / sum;
  if (phase != nullptr) *phase += std::arg((1.0 + interface) * std::conj(sum));
}

void add_to_both(double phase, LayerPhases& phases) {
  phases.te += phase;
  phases.tm += phase;
}

}  // namespace

LayerStack::LayerStack(std::span<const Layer> layers, double frequency) : wavenumber_(kTwoPi * frequency / kSpeedOfLight) {
  for (const Layer& layer : layers) {
    const double loss = layer.conductivity / (kTwoPi * frequency * kVacuumPermittivity);
    slices_.push_back({layer.permittivity - Complex(0.0, loss), wavenumber_ * layer.thickness});
    phase_ += slices_.back().phase;
  }
}

LayerStack::Joined LayerStack::joined(double cos_incidence, LayerPhases* phases) const {
  const Side air{1.0, cos_incidence};
  Joined out{{0.0, 0.0}, {1.0, 1.0}};
  Side behind = air;
  Complex through = 1.0;  // the layer that lies before `behind`
  for (size_t k = slices_.size() + 1; k-- > 0;) {
    const Side before =
        k == 0 ? air : Side{slices_[k - 1].permittivity, transmitted_cosine(slices_[k - 1].permittivity, cos_incidence)};
    const Interface at = reflection_between(before, behind);
    join(at.te, through, out.reflection.te, out.transmission.te, phases != nullptr ? &phases->te : nullptr);
    join(at.tm, through, out.reflection.tm, out.transmission.tm, phases != nullptr ? &phases->tm : nullptr);
    if (k > 0) {
      through = std::exp(Complex(0.0, -slices_[k - 1].phase) * before.cosine);
      if (phases != nullptr) add_to_both(-slices_[k - 1].phase * before.cosine.real(), *phases);
    }
    behind = before;
  }
  return out;
}

// A wave along the faces enters nothing.
FresnelModes LayerStack::reflection(double cos_incidence) const {
  if (cos_incidence <= 0.0) return {-1.0, -1.0};
  return joined(cos_incidence).reflection;
}

// The magnetic field that joins the TM parts is the electric one again behind the stack.
LayerTransmission LayerStack::transmission(double cos_incidence) const {
  if (cos_incidence <= 0.0) return {0.0, 0.0};
  return joined(cos_incidence).transmission;
}

LayerTransmission LayerStack::over_free_space(double cos_incidence, LayerPhases* phases) const {
  const double straight = phase_ * cos_incidence;
  if (phases != nullptr) *phases = {straight, straight};
  if (cos_incidence <= 0.0) return {0.0, 0.0};
  const LayerTransmission found = joined(cos_incidence, phases).transmission;
  const Complex free = std::polar(1.0, straight);
  return {found.te * free, found.tm * free};
}

double LayerStack::offset(double cos_incidence) const {
  const double sine = std::sqrt(std::max(0.0, 1.0 - cos_incidence * cos_incidence));
  double across = 0.0;
  for (const Slice& slice : slices_) {
    const double inside = transmitted_cosine(slice.permittivity, cos_incidence).real();
    if (inside > 0.0) across += slice.phase / wavenumber_ * sine * (1.0 - cos_incidence / inside);
  }
  return across;
}

double LayerStack::most_phase() const {
  double phase = 0.0;
  for (const Slice& slice : slices_) phase += 2.0 * slice.phase * std::max(1.0, std::sqrt(std::abs(slice.permittivity)));
  return phase;
}

}  // namespace echopath
