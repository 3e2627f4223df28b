#pragma once
// Says how the phase of the signal of an echo in the middle of the samples of a chirp follows from its length.
#include <complex>
#include <span>
#include <vector>

#include "echopath/radar/radar.h"

namespace echopath {

// The phase is 2 pi {(f0 + mu t_m) tau - mu tau^2 / 2}, as in signal/kernels/carrier.h.
class MiddlePhase {
 public:
  explicit MiddlePhase(const ChirpSequence& waveform);
  std::complex<double> of(double length) const;  // m

 private:
  double carrier_, half_slope_;  // Hz, Hz/s
};

// Returns the phase factors of echoes of some lengths (m).
std::vector<std::complex<double>> middle_phases(const ChirpSequence& waveform, std::span<const double> lengths);

}  // namespace echopath
