#pragma once
// Holds the input of IF synthesis: delays and amplitudes of echoes over the chirps of a frame, for one channel.
#include <complex>
#include <cstdint>
#include <vector>

namespace echopath {

// Says how a few rows of values give values at each chirp: value(chirp j) = sum_k value[j][k] * row[first_row[j] + k], and
// the same with `slope` for the time derivative. One form holds static echoes (one row, weight 1), Chebyshev pieces (a row
// for each of the K nodes of a piece of the frame), exact evaluation (rows for a few nodes in every chirp) and chirps that
// know their own derivatives.
struct TimeSampling {
  int num_rows = 1;
  int order = 1;               // rows that take part in one chirp
  std::vector<int> first_row;  // [T]
  std::vector<double> value;   // [T, order]
  std::vector<double> slope;   // [T, order], 1/s
  // [T, order] each, 1/s^2 and 1/s^3; empty where chirps are taken as linear in time.
  std::vector<double> second_derivative, third_derivative;
  // Says what a row holds, to be multiplied by the weights above.
  enum class Rows {
    kValues,  // at a node
    // Likewise, but amplitudes stand as (natural logarithm of the size, phase in rad) and are interpolated as such: so few
    // rows hold a phase that turns through many cycles. Phases go on beyond one turn from row to row. Sizes below e^-708
    // are 0.
    kLogarithms,
    // The rows of a chirp are its own value, slope, second and third derivative, as many as the order; each has the weight 1
    // for what it is, and amplitudes have a value alone.
    kDerivatives,
  };
  Rows rows = Rows::kValues;
  // Returns whether all chirps see the one row: then the echoes do not move, and are synthesised once for all chirps.
  bool is_static() const { return num_rows == 1; }
};

TimeSampling static_sampling(int num_chirps);
// Returns the sampling with one row per chirp at `times` [T] (s, ascending, T >= 1), for measured or tabulated delays.
// Slopes are second-order differences (zero when T = 1).
TimeSampling exact_sampling(const std::vector<double>& times);

struct Echoes {
  TimeSampling sampling;
  int64_t num_echoes = 0;
  std::vector<double> delay;                    // [num_rows, num_echoes] s, at the window centre, round trip
  std::vector<std::complex<double>> amplitude;  // [num_rows, num_echoes] sqrt(W), unless rows hold logarithms
  std::vector<uint32_t> group;                  // [num_echoes], or empty: all in group 0
};

}  // namespace echopath
