#pragma once
// Samples and maps of echoes as plain double sums over their formulas.
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "echopath/radar/radar.h"
#include "echopath/spectrum/window.h"

namespace echopath::testing {

// One echo in one chirp: delay at the middle of the samples, its rate, and the amplitude.
struct ChirpEcho {
  double delay, rate;              // s, s/s
  std::complex<double> amplitude;  // sqrt(W)
};

inline std::complex<double> turn(double cycles) {
  return std::polar(1.0, 2.0 * std::numbers::pi * (cycles - std::floor(cycles)));
}

// Adds the samples of an echo, by the model of signal/kernels/carrier.h.
inline void add_samples(const ChirpSequence& waveform, const ChirpEcho& echo, std::complex<double>* samples) {
  const double slope = waveform.slope(), middle = waveform.window_centre(), f0 = waveform.start_frequency;
  const double beat = slope * echo.delay + (f0 + slope * middle - slope * echo.delay) * echo.rate;
  const double start = f0 * echo.delay + slope * middle * echo.delay - 0.5 * slope * echo.delay * echo.delay;
  for (int n = 0; n < waveform.num_samples; ++n) {
    samples[n] += std::conj(echo.amplitude) * turn(start + beat * (n / waveform.sampling_rate - middle));
  }
}

// Returns |windowed Fourier sum|^2 [V, R] of samples [chirp, sample], V ascending with rest in the middle.
inline std::vector<double> slow_power(const std::vector<std::complex<double>>& samples, const ChirpSequence& waveform,
                                      const Window& window, int zero_pad) {
  const int num_chirps = waveform.num_chirps, num_samples = waveform.num_samples;
  const std::vector<double> over_chirps = window_samples(window, num_chirps),
                            over_samples = window_samples(window, num_samples);
  double sum = 0.0;
  for (const double chirp : over_chirps) {
    for (const double sample : over_samples) sum += chirp * sample;
  }
  std::vector<double> power;
  for (int v = 0; v < zero_pad * num_chirps; ++v) {
    for (int r = 0; r < zero_pad * num_samples; ++r) {
      std::complex<double> value = 0.0;
      for (int c = 0; c < num_chirps; ++c) {
        for (int n = 0; n < num_samples; ++n) {
          const double doppler = static_cast<double>(v - zero_pad * num_chirps / 2) * c / (zero_pad * num_chirps);
          const double range = static_cast<double>(r) * n / (zero_pad * num_samples);
          value += over_chirps[c] * over_samples[n] * samples[c * num_samples + n] * turn(-doppler - range);
        }
      }
      power.push_back(std::norm(value / sum));
    }
  }
  return power;
}

}  // namespace echopath::testing
