#include "echopath/signal/methods/per_sample.h"

#include <cmath>

#include "echopath/base/lanes/phasor.h"
#include "echopath/signal/echoes/echoes.h"

namespace echopath {
namespace {

// Describes one echo over a chirp. The phase at the window centre is reduced once; the phase added over the chirp is small.
struct EchoOfChirp {
  double re, im;  // conj(a), or a of chirps that fall, sqrt(W)
  double delay;   // s
  double cycles;  // at the window centre, reduced
  double rate, half_second, sixth_third;
};

EchoOfChirp echo_of_chirp(const CarrierModel& model, const EchoStates& states, const EchoDerivatives& derivatives, int p) {
  const double tau = states.delay[p], f0 = model.start_frequency;
  const double cycles = std::fma(f0, tau, -std::round(f0 * tau)) + model.slope * tau * (model.window_centre - 0.5 * tau);
  return {states.amplitude[2 * p],
          -model.sense * states.amplitude[2 * p + 1],
          tau,
          cycles,
          states.rate[p],
          derivatives.second[p] / 2.0,
          derivatives.third[p] / 6.0};
}

// Returns whether the beat frequency in the middle of the chirp lies in the band of the anti-alias filter.
bool passes_filter(const CarrierModel& model, const EchoOfChirp& echo) {
  const double swept = model.slope * echo.delay;
  const double beat = swept + (model.start_frequency + model.slope * model.window_centre - swept) * echo.rate;
  const double frequency = beat * model.sample_interval;
  return frequency >= 0.0 && frequency < model.highest_frequency;
}

// Returns the value of the echo at a sample, in sqrt(W).
ECHOPATH_INLINE Phasor value_at(const CarrierModel& model, const EchoOfChirp& echo, double sample) {
  const double slope = model.slope, centre = model.window_centre;
  const double carrier = model.start_frequency + slope * (centre - echo.delay);
  const double x = sample * model.sample_interval - centre;
  const double moved = x * (echo.rate + x * (echo.half_second + x * echo.sixth_third));  // s since the window centre
  const double cycles = echo.cycles + carrier * moved + slope * (x * (echo.delay + moved) - 0.5 * moved * moved);
  const Phasor phasor = phasor_of_cycles(cycles);
  return {echo.re * phasor.re - echo.im * phasor.im, echo.re * phasor.im + echo.im * phasor.re};
}

ECHOPATH_INLINE void add_echo(CarrierModel model, EchoOfChirp echo, int num_samples, double* out_re, double* out_im) {
  for (int n = 0; n < num_samples; ++n) {
    const Phasor value = value_at(model, echo, n);
    out_re[n] += value.re;
    out_im[n] += value.im;
  }
}

// Calls visit(echo, index) for each of the echoes [begin, begin + count) of a chirp that pass the filter.
template <class Visit>
void visit_echoes(const CarrierModel& model, const Echoes& echoes, int chirp, int64_t begin, int count, Visit visit) {
  EchoStates states;
  EchoDerivatives derivatives;
  evaluate_states(echoes, chirp, begin, count, states, &derivatives);
  for (int p = 0; p < count; ++p) {
    const EchoOfChirp echo = echo_of_chirp(model, states, derivatives, p);
    if (passes_filter(model, echo)) visit(echo, static_cast<size_t>(begin + p));
  }
}

}  // namespace

void PerSample::add(const Echoes& echoes, int chirp, int64_t begin, int count, int64_t row_length, Rows rows) const {
  visit_echoes(model_, echoes, chirp, begin, count, [&](const EchoOfChirp& echo, size_t index) {
    double* row = rows.of_group[echoes.group.empty() ? 0 : echoes.group[index]] + rows.first;
    run_simd<add_echo>(model_, echo, num_samples_, row, row + row_length);
  });
}

void PerSample::add_samples(const Echoes& echoes, int chirp, int64_t begin, int count, std::span<const double> samples,
                            std::span<double> re, std::span<double> im) const {
  visit_echoes(model_, echoes, chirp, begin, count, [&](const EchoOfChirp& echo, size_t) {
    for (size_t s = 0; s < samples.size(); ++s) {
      const Phasor value = value_at(model_, echo, samples[s]);
      re[s] += value.re;
      im[s] += value.im;
    }
  });
}

}  // namespace echopath
