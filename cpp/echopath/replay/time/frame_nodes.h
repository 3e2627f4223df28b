#pragma once
// At which times of a frame paths are evaluated, and how values at each chirp follow from them.
#include <vector>

#include "echopath/radar/radar.h"
#include "echopath/signal/echoes.h"

namespace echopath {

struct FrameNodes {
  std::vector<double> times;            // [num_nodes] s
  std::vector<TimeSampling> sampling;   // by transmitter
  int order = 1;                        // nodes per piece; 1: one node for all
  bool is_exact = false;                // nodes in every chirp

  // Rows [2, order] that give the last two Chebyshev coefficients of a piece from its nodes: what the polynomial
  // has left. Empty for order 1 and exact nodes.
  std::vector<double> tail;
  int num_pieces() const { return order > 1 && !is_exact ? static_cast<int>(times.size()) / order : 0; }
};

// Which derivatives inside a chirp are wanted: the slope, or the second and the third too (TimeSampling).
enum class ChirpDerivatives { kFirst, kThird };

// One node, at `time`.
FrameNodes static_nodes(const Radar& radar, double time);
// `order` Chebyshev-Lobatto nodes in each piece between the breakpoints (s, ascending) that lie inside the frame that starts
// at start_time. Derivatives are those of the same polynomial.
FrameNodes chebyshev_nodes(const Radar& radar, double start_time, const std::vector<double>& breakpoints, int order,
                           ChirpDerivatives derivatives = ChirpDerivatives::kThird);
// The same without their sampling, which is what costs.
FrameNodes unsampled_chebyshev_nodes(const Radar& radar, double start_time, const std::vector<double>& breakpoints, int order);
// `order` (odd) such nodes in every chirp of one transmitter, which alone has a sampling; the middle one at the window centre.
FrameNodes exact_nodes(const Radar& radar, double start_time, int order, int transmitter,
                       ChirpDerivatives derivatives = ChirpDerivatives::kThird);
// One node in each chirp of one transmitter, at its window centre; no sampling.
FrameNodes centre_nodes(const Radar& radar, double start_time, int transmitter);
// Nodes in the place of those of centre_nodes that hold a value and then its derivatives: 1 of the first kind, 3 of the third.
// They stand at chirp * (1 + derivatives) of the nodes.
TimeSampling derivative_sampling(int num_chirps, ChirpDerivatives derivatives);
// Pieces into which breakpoints cut the frame that starts at start_time.
int64_t num_pieces(const Radar& radar, double start_time, const std::vector<double>& breakpoints);

}  // namespace echopath
