#pragma once
// Estimates what polynomials through the nodes of a frame leave out, from the last two Chebyshev coefficients of each piece.
#include <vector>

#include "echopath/replay/time/frame_nodes.h"

namespace echopath {

// Holds the largest tails of all pieces.
struct ChebyshevTails {
  std::vector<double> delay;      // [P] s
  std::vector<double> amplitude;  // [P] relative to the largest amplitude of the path; 0 where that is 0
};

// Returns the tails of echoes at the nodes of chebyshev_nodes.
ChebyshevTails chebyshev_tails(const FrameNodes& nodes, const Echoes& echoes);
// Returns the tails of amplitudes that stand as logarithms (TimeSampling::Rows), [P], relative to the amplitude.
std::vector<double> tails_of_logarithms(const FrameNodes& nodes, const Echoes& echoes);

// Returns whether the amplitude of an echo stays below `limit` (sqrt(W)) at its nodes and between them. It takes the
// logarithm of the amplitude for a parabola between neighbouring nodes, as the filter of a launch cell makes it: an echo
// that would flare up between two nodes is not dark, however little it has at the nodes.
bool is_dark(const FrameNodes& nodes, const Echoes& echoes, size_t echo, double limit);

// Returns whether a function stays below `limit` likewise, of which `values` has the logarithms at the nodes, [num_nodes],
// or what lies above them. `limit` is a logarithm too.
bool stays_below(const FrameNodes& nodes, const double* values, double limit);

// Returns the tail of one sequence of values, [num_nodes].
double tail_of(const FrameNodes& nodes, const std::vector<double>& values);

}  // namespace echopath
