#pragma once
// Computes the frequency and the phasor of echoes within a chirp, for a vector of echoes at a time.
#include <numbers>

#include "echopath/base/lanes/lane_math.h"
#include "echopath/base/lanes/phasor.h"
#include "echopath/base/lanes/vecs.h"
#include "echopath/signal/kernels/kernels.h"

namespace echopath::ECHOPATH_KERNELS {
namespace {

// The amplitude is (re + j im) e^{j pi turned}.
template <int kCount>
struct States {
  Vecs<kCount> delay, rate, re, im, turned;
};
template <int kCount>
struct Tones {
  Vecs<kCount> frequency, re, im;
};

// Computes the phase model of carrier.h, in half turns.
template <PhasorError kError, int kCount>
ECHOPATH_INLINE Tones<kCount> tones_of(const CarrierModel& model, const States<kCount>& states) {
  const double centre = 2.0 * model.centre_frequency, rest = 2.0 * model.centre_frequency_rest;
  const Vecs<kCount>& tau = states.delay;
  const Vecs<kCount> swept = tau * (model.slope * model.sample_interval);
  const Vecs<kCount> frequency = states.rate * (model.centre_frequency * model.sample_interval - swept) + swept;
  const Vecs<kCount> beside =
      (tau * (rest - tau * model.slope) + frequency * (2.0 * model.reference_offset)) - states.turned;
  const Vecs<kCount> turns = (tau * centre + beside) + kRoundingShift;
  const Vecs<kCount> left = exact_multiply_add(tau, centre, kRoundingShift - turns) + beside;
  const ComplexOf<Vecs<kCount>> phasor = phasor_of_half_turns<kError>(left);
  Tones<kCount> out;
#pragma GCC unroll 8
  for (int i = 0; i < kCount; ++i) {
    const Mask sign = bits(turns.of[i]) << 63;  // of an odd number of half turns
    const Vec c = from_bits(bits(phasor.re.of[i]) ^ sign), s = from_bits(bits(phasor.im.of[i]) ^ sign);
    const Vec f = frequency.of[i], re = states.re.of[i], im = states.im.of[i] * model.sense;
    const Mask kept = (f >= 0.0) & (f < model.highest_frequency);
    out.frequency.of[i] = kept ? f : Vec{};
    out.re.of[i] = kept ? re * c + im * s : Vec{};
    out.im.of[i] = kept ? re * s - im * c : Vec{};
  }
  return out;
}

// Takes back the logarithms that stand as re and im. The phases go on into those of the carriers, which costs no phasor.
template <int kCount>
ECHOPATH_INLINE void undo_logarithms(const CarrierModel& model, States<kCount>& states) {
  const double per_pi = model.sense * std::numbers::inv_pi;
#pragma GCC unroll 4
  for (int i = 0; i < kCount; ++i) {
    states.turned.of[i] = states.im.of[i] * per_pi;
    states.re.of[i] = LaneMath::exp(states.re.of[i]);
    states.im.of[i] = Vec{};
  }
}

// What stands beyond the last echo, in the rest of its vector, need not be a logarithm: it counts as 0.
void undo_logarithms(double* amplitude, int count) {
  for (int p = count; p % kLanes != 0; ++p) amplitude[2 * p] = amplitude[2 * p + 1] = 0.0;
  for (int p = 0; p < count; p += kLanes, amplitude += 2 * kLanes) {
    const Vec first = load(amplitude), second = load(amplitude + kLanes);
    const Vec size = LaneMath::exp(every_other<0>(first, second));
    const ComplexOf<Vec> phasor = LaneMath::cis(every_other<1>(first, second));
    const Vec re = size * phasor.re, im = size * phasor.im;
    store(amplitude, interleaved<0>(re, im));
    store(amplitude + kLanes, interleaved<1>(re, im));
  }
}

void modulate(const CarrierModel& model, const EchoStates& states, int count, Carriers& out) {
  for (int p = 0; p < count; p += kLanes) {
    const Vec first = load(states.amplitude + 2 * p), second = load(states.amplitude + 2 * p + kLanes);
    const Vec re = every_other<0>(first, second), im = every_other<1>(first, second);
    const States<1> here{{load(states.delay + p)}, {load(states.rate + p)}, {re}, {im}, {}};
    const Tones<1> tones = tones_of<PhasorError::kRounding>(model, here);
    store(out.frequency + p, tones.frequency.of[0]);
    store(out.re + p, tones.re.of[0]);
    store(out.im + p, tones.im.of[0]);
  }
}

}  // namespace
}  // namespace echopath::ECHOPATH_KERNELS
