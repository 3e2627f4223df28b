#pragma once
// Many moving echoes, for tests of how the NUFFT adds them.

#include "cpp/signal/slow_sum.h"

namespace echopath::testing {

inline ChirpSequence few_chirps(int num_chirps = 7) {
  ChirpSequence w = reference_waveform();
  w.num_chirps = num_chirps;  // of which the last ones do not fill the lanes of a vector
  return w;
}

inline double cell_delay(const ChirpSequence& w) { return w.sampling_rate / w.slope() / (2 * w.num_samples); }

// Straight motion between two nodes: what replay hands over, with one polynomial for all chirps.
inline Echoes two_node_echoes(const ChirpSequence& w, const std::vector<double>& delay, const std::vector<double>& drift,
                              const std::vector<Complex>& amplitude) {
  Echoes echoes;
  echoes.num_echoes = static_cast<int64_t>(delay.size());
  echoes.sampling.num_rows = echoes.sampling.order = 2;
  echoes.sampling.first_row.assign(w.num_chirps, 0);
  const double span = w.num_chirps * w.chirp_interval;
  for (int j = 0; j < w.num_chirps; ++j) {
    const double x = (j + 0.5) / w.num_chirps;
    echoes.sampling.value.insert(echoes.sampling.value.end(), {1.0 - x, x});
    echoes.sampling.slope.insert(echoes.sampling.slope.end(), {-1.0 / span, 1.0 / span});
  }
  echoes.delay = delay;
  for (size_t p = 0; p < delay.size(); ++p) echoes.delay.push_back(delay[p] + drift[p]);
  echoes.amplitude = amplitude;
  for (const Complex& a : amplitude) echoes.amplitude.push_back(a * Complex(0.9, 0.1));
  return echoes;
}

// Echoes over `cells` cells from a delay on, each drifting at random by up to `drift` cells over the frame.
inline Echoes crowd(const ChirpSequence& w, int count, double from, double cells, double drift) {
  std::mt19937_64 random(17);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<double> delay, drifts;
  std::vector<Complex> amplitude;
  for (int p = 0; p < count; ++p) {
    delay.push_back(from + cells * cell_delay(w) * unit(random));
    drifts.push_back(drift * cell_delay(w) * (2.0 * unit(random) - 1.0));
    amplitude.push_back(std::polar(std::pow(10.0, -2.0 * unit(random)), 6.283 * unit(random)));
  }
  return two_node_echoes(w, delay, drifts, amplitude);
}

inline double rms_error(const std::vector<Complex>& actual, const std::vector<Complex>& expected, double scale) {
  double sum = 0.0;
  for (size_t i = 0; i < actual.size(); ++i) sum += std::norm(actual[i] - expected[i]);
  return std::sqrt(sum / static_cast<double>(actual.size())) / scale;
}

}  // namespace echopath::testing
