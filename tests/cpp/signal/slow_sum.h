#pragma once
// The IF model of the reference text, written out sample by sample in extended precision, and test echoes.
#include <cmath>
#include <complex>
#include <random>
#include <vector>

#include "cpp/support/waveforms.h"
#include "echopath/radar/radar.h"
#include "echopath/signal/synthesizer.h"

namespace echopath::testing {

using Complex = std::complex<double>;

// One chirp [num_samples] of moving points: tau + taudot (t - t_m), phases in long double.
inline std::vector<Complex> slow_chirp(const ChirpSequence& w, const std::vector<double>& tau,
                                       const std::vector<double>& taudot, const std::vector<Complex>& amplitude) {
  using Real = long double;
  const Real mu = Real{w.bandwidth} * w.sampling_rate / w.num_samples;
  const Real tm = Real(w.num_samples - 1) / (2 * Real{w.sampling_rate});
  const Real f0 = w.start_frequency;
  std::vector<std::complex<Real>> sum(w.num_samples);
  for (size_t p = 0; p < tau.size(); ++p) {
    const Real t0 = tau[p];
    const Real beat = mu * t0 + (f0 + mu * tm - mu * t0) * Real{taudot[p]};
    const Real highest = w.real ? Real{w.sampling_rate} / 2 : Real{w.sampling_rate};
    const Real upward = w.bandwidth < 0.0 ? -beat : beat;
    if (upward < 0 || upward >= highest) continue;
    for (int n = 0; n < w.num_samples; ++n) {
      const Real t = n / Real{w.sampling_rate};
      const Real cycles = f0 * t0 + mu * tm * t0 - mu * t0 * t0 / 2 + beat * (t - tm);
      const Real angle = 2 * std::numbers::pi_v<Real> * (cycles - std::round(cycles));
      sum[n] += std::complex<Real>(std::conj(amplitude[p])) * std::complex<Real>(std::cos(angle), std::sin(angle));
    }
  }
  std::vector<Complex> out(w.num_samples);
  for (int n = 0; n < w.num_samples; ++n) {
    out[n] = w.real ? Complex(static_cast<double>(std::sqrt(Real{2}) * sum[n].real()), 0.0)
                    : Complex(static_cast<double>(sum[n].real()), static_cast<double>(sum[n].imag()));
  }
  return out;
}

// Points with random ranges, speeds, phases and powers, moving on straight lines over the chirps.
struct MovingPoints {
  std::vector<double> range, speed;  // m at the first chirp, m/s
  std::vector<Complex> amplitude;    // sqrt(W)

  MovingPoints(int count, unsigned seed, double min_range, double max_range) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (int p = 0; p < count; ++p) {
      range.push_back(min_range + (max_range - min_range) * unit(random));
      speed.push_back(60.0 * unit(random) - 30.0);
      amplitude.push_back(std::polar(std::pow(10.0, -2.0 * unit(random)), 6.283 * unit(random)));
    }
  }
};

inline std::vector<double> chirp_times(const ChirpSequence& w) {
  std::vector<double> times;
  for (int j = 0; j < w.num_chirps; ++j) times.push_back(j * w.chirp_interval);
  return times;
}

// Echoes with one node per chirp.
inline Echoes exact_echoes(const ChirpSequence& w, const MovingPoints& points) {
  Echoes echoes;
  const std::vector<double> times = chirp_times(w);
  echoes.sampling = exact_sampling(times);
  echoes.num_echoes = static_cast<int64_t>(points.range.size());
  for (const double t : times) {
    for (size_t p = 0; p < points.range.size(); ++p) {
      echoes.delay.push_back(2.0 * (points.range[p] + points.speed[p] * t) / 299792458.0);
      echoes.amplitude.push_back(points.amplitude[p] * (1.0 + 0.1 * t));
    }
  }
  return echoes;
}

inline Echoes static_echoes(int num_chirps, const std::vector<double>& delay, const std::vector<Complex>& amplitude) {
  Echoes echoes;
  echoes.sampling = static_sampling(num_chirps);
  echoes.num_echoes = static_cast<int64_t>(delay.size());
  echoes.delay = delay;
  echoes.amplitude = amplitude;
  return echoes;
}

inline std::vector<Complex> synthesize(const ChirpSequence& w, const Echoes& echoes, const SynthesisOptions& options) {
  Synthesizer synthesizer(w, 1, 1, echoes.num_echoes, options);
  synthesizer.add(0, echoes);
  return synthesizer.cube();
}

inline double largest_difference(const std::vector<Complex>& a, const std::vector<Complex>& b) {
  double largest = a.size() == b.size() ? 0.0 : INFINITY;
  for (size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    const double difference = std::abs(a[i] - b[i]);
    if (!(difference <= largest)) largest = difference;  // what is not a number stays
  }
  return largest;
}

inline double sum_of_magnitudes(const std::vector<Complex>& amplitude) {
  double sum = 0.0;
  for (const Complex& a : amplitude) sum += std::abs(a);
  return sum;
}

}  // namespace echopath::testing
