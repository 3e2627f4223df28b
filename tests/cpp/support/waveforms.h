#pragma once
// Waveforms that several C++ tests share.
#include "echopath/radar/radar.h"

namespace echopath::testing {

// That of the reference text.
inline ChirpSequence reference_waveform() {
  return {.start_frequency = 77e9,
          .bandwidth = 1e9,
          .num_samples = 512,
          .sampling_rate = 20e6,
          .num_chirps = 128,
          .chirp_interval = 30e-6,
          .real = false};
}

// A frame that is small enough for slow sums, of the same carrier and chirp interval. bandwidth, sampling_rate: Hz
inline ChirpSequence small_waveform(double bandwidth, double sampling_rate, int num_samples, int num_chirps) {
  ChirpSequence waveform = reference_waveform();
  waveform.bandwidth = bandwidth;
  waveform.sampling_rate = sampling_rate;
  waveform.num_samples = num_samples;
  waveform.num_chirps = num_chirps;
  return waveform;
}

}  // namespace echopath::testing
