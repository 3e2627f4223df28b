#pragma once
// Defines the kinds of time grid at whose nodes paths are evaluated. A node holds a value, never a derivative.
#include <variant>
#include <vector>

#include "echopath/replay/time/frame_nodes.h"

namespace echopath {

// Describes a grid for what does not move: one node serves the whole frame.
struct StillGrid {
  double time;  // s
};

// A polynomial runs through `order` Chebyshev-Lobatto nodes in each piece of the frame between the cuts.
struct PolynomialGrid {
  enum class Pieces { kSmooth, kAnalytic };  // between breakpoints of motions, or between the knots of their splines too
  int order;
  Pieces pieces;
  std::vector<double> cuts;  // s, ascending, inside the frame
  int64_t num_nodes;         // of all pieces
  double longest_piece;      // s
};

// Each chirp of one transmitter has one node, in the middle of its window. How delays change within the chirp is taken from
// a polynomial.
struct ChirpGrid {
  int transmitter;
};

// Each chirp of one transmitter has `order` (odd) nodes of its own, so that delays are known at all of its samples.
struct SampleGrid {
  int transmitter, order;
};

using TimeGrid = std::variant<StillGrid, PolynomialGrid, ChirpGrid, SampleGrid>;

// Returns the times of the nodes in the frame that starts at `start_time` (s) and how values at each chirp follow from them
// (nothing for a ChirpGrid).
FrameNodes nodes_of(const TimeGrid& grid, const Radar& radar, double start_time, ChirpDerivatives derivatives);

// Returns the only transmitter that the nodes belong to, -1 where they belong to all.
int transmitter_of(const TimeGrid& grid);

}  // namespace echopath
