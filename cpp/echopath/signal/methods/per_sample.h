#pragma once
// Adds moving echoes with the delay of every sample, for rotors and other targets that are too fast for the linear model of
// carrier.h:
//   s[n] = sum conj(a) exp(j 2 pi {f0 tau + mu t tau - mu tau^2 / 2}),   t = n / fs,
//   tau(t) = tau_m + tau' x + tau'' x^2 / 2 + tau''' x^3 / 6,  x = t - t_m.
// The series leaves out tau'''' x^4 / 24: 5e-7 rad at 77 GHz for a blade of 0.3 m at 800 rad/s in chirps of 25.6 us.
#include <span>

#include "echopath/radar/radar.h"
#include "echopath/signal/methods/method.h"

namespace echopath {

class PerSample {
 public:
  PerSample(const ChirpSequence& waveform, const CarrierModel& model) : num_samples_(waveform.num_samples), model_(model) {}

  // Adds echoes [begin, begin + count) of a chirp, each to the row of its group, whose parts are `row_length` long.
  void add(const Echoes& echoes, int chirp, int64_t begin, int count, int64_t row_length, Rows rows) const;
  // Adds those echoes, of all groups, to a few samples [S] of the chirp.
  void add_samples(const Echoes& echoes, int chirp, int64_t begin, int count, std::span<const double> samples,
                   std::span<double> re, std::span<double> im) const;

 private:
  int num_samples_;
  CarrierModel model_;
};

}  // namespace echopath
