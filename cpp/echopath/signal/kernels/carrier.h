#pragma once
// Finds the beat frequency and start phase of each echo at one chirp (the formula itself is tones_of in kernels_body.h).
//
// Model "lin": over one chirp the delay is linear in time about the window centre t_m. With n the sample, t = n / fs,
//   s[n] = sum conj(a) exp(j 2 pi {f0 tau + mu t_m tau - mu tau^2 / 2 + f_b (t - t_m)}),
//   f_b  = mu tau + (f0 + mu t_m - mu tau) taudot.
// Against the exact phase this errs by 2 pi mu taudot (Tc / 2)^2: 0.0027 rad at 10 m/s, 1 GHz, 25.6 us; per_sample.h has no
// such error.
//
// Chirps that fall (mu < 0) have beats of negative frequencies. The conjugate of their signal is that of chirps that rise,
// with a negative carrier: s*(f0, mu, a) = s(-f0, -mu, a*). Carriers and rows are those of the conjugate then, and samples
// are conjugated when they are read.
#include <cstdint>

#include "echopath/signal/echoes/echo_states.h"

namespace echopath {

struct ChirpSequence;

// Holds at most kCapacity echoes at one chirp: echo p is (re + j im)[p] e^{j 2 pi frequency[p] (n - reference sample)}.
struct Carriers {
  static constexpr int kCapacity = EchoStates::kCapacity;
  int count = 0;
  const uint32_t* group = nullptr;          // [count]
  alignas(64) double frequency[kCapacity];  // cycles per sample, in [0, 1)
  alignas(64) double re[kCapacity];         // sqrt(W); 0 where the anti-alias filter removed the echo
  alignas(64) double im[kCapacity];
};

// Holds the constants of the phase model. The phase of the carriers is taken at `reference_sample`. Frequencies are negative
// where chirps fall, whose slope is taken with the other sign.
struct CarrierModel {
  CarrierModel(const ChirpSequence& waveform, int reference_sample);
  double sense;              // 1, or -1 where chirps fall: amplitudes are conjugated
  double start_frequency;    // Hz
  double slope;              // Hz/s, positive
  double window_centre;      // s
  double sample_interval;    // s
  double reference_offset;   // samples from the window centre to the reference sample
  double highest_frequency;  // cycles per sample; beat frequencies outside [0, highest) are removed
  // f0 + mu t_m is stored as a sum of two: the carrier turns 1e4 to 1e6 times, and one rounding of it would leave 1e-11 rad.
  double centre_frequency, centre_frequency_rest;  // Hz
};

// Finds the carriers of echoes [begin, begin + count) at `chirp`; count <= Carriers::kCapacity. Phases are right to 7e-14
// rad.
void evaluate_carriers(const CarrierModel& model, const Echoes& echoes, int chirp, int64_t begin, int count, Carriers& out);

}  // namespace echopath
