#pragma once
// Holds the input of IF synthesis: delays and amplitudes of echoes over the chirps of a frame, for one channel.
#include <complex>
#include <cstdint>
#include <vector>

namespace echopath {

// Says how values at a few nodes give values at each chirp: value(chirp j) = sum_k value[j][k] * node[first_node[j] + k],
// and the same with `slope` for the time derivative. One form holds static echoes (one node, weight 1), Chebyshev pieces (K
// nodes per piece of the frame) and exact evaluation (a few nodes in every chirp).
struct TimeSampling {
  int num_nodes = 1;
  int order = 1;                 // nodes that take part in one chirp
  std::vector<int> first_node;   // [T]
  std::vector<double> value;     // [T, order]
  std::vector<double> slope;     // [T, order], 1/s
  // [T, order] each, second and third derivative in 1/s^2 and 1/s^3; empty where chirps are taken as linear in time.
  std::vector<double> bend, twist;
  // Where this is set, the nodes of a chirp do not hold values at several times but the chirp's own value, slope, second and
  // third derivative, as many as the order.
  bool holds_derivatives = false;
  // Returns whether all chirps see the one node: then the echoes do not move, and are synthesised once for all chirps.
  bool is_static() const { return num_nodes == 1; }
};

TimeSampling static_sampling(int num_chirps);
// Returns the sampling with one node per chirp at `times` [T] (s, ascending, T >= 1), for measured or tabulated delays.
// Slopes are second-order differences (zero when T = 1).
TimeSampling exact_sampling(const std::vector<double>& times);

struct Echoes {
  TimeSampling sampling;
  int64_t num_echoes = 0;
  std::vector<double> delay;                     // [num_nodes, num_echoes] s, at the window centre, round trip
  std::vector<std::complex<double>> amplitude;   // [num_nodes, num_echoes] sqrt(W)
  std::vector<uint32_t> group;                   // [num_echoes], or empty: all in group 0
};

}  // namespace echopath
