#include "echopath/label/cells/middle_phase.h"

#include "echopath/base/constants.h"
#include "echopath/base/lanes/phasor.h"
#include "echopath/base/threads/parallel.h"

namespace echopath {
namespace {

constexpr int64_t kLengthsTogether = 1 << 13;

}  // namespace

MiddlePhase::MiddlePhase(const ChirpSequence& waveform)
    : carrier_(waveform.start_frequency + waveform.slope() * waveform.window_centre()), half_slope_(0.5 * waveform.slope()) {
}

std::complex<double> MiddlePhase::of(double length) const {
  const double delay = length / kSpeedOfLight, cycles = carrier_ * delay - half_slope_ * delay * delay;
  const Phasor phasor = phasor_of_cycles(cycles);
  return {phasor.re, phasor.im};
}

std::vector<std::complex<double>> middle_phases(const ChirpSequence& waveform, std::span<const double> lengths) {
  const MiddlePhase phase(waveform);
  std::vector<std::complex<double>> phases(lengths.size());
  parallel_for_chunks(std::ssize(lengths), kLengthsTogether, [&](int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; ++i) phases[i] = phase.of(lengths[i]);
  });
  return phases;
}

}  // namespace echopath
