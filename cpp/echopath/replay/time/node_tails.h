#pragma once
// Estimates what polynomials through the nodes of a frame leave out, from the last two Chebyshev coefficients of each piece.
#include <vector>

#include "echopath/replay/time/frame_nodes.h"

namespace echopath {

// Holds the largest tails of all pieces.
struct NodeTails {
  std::vector<double> delay;      // [P] s
  std::vector<double> amplitude;  // [P] relative to the largest amplitude of the path; 0 where that is 0
};

// Returns the tails of echoes at the nodes of chebyshev_nodes.
NodeTails node_tails(const FrameNodes& nodes, const Echoes& echoes);

// Returns the tail of one sequence of values, [num_nodes].
double tail_of(const FrameNodes& nodes, const std::vector<double>& values);

}  // namespace echopath
