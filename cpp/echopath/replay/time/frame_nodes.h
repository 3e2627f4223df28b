#pragma once
// Says at which times of a frame paths are evaluated, and how values at each chirp follow from them.
#include <vector>

#include "echopath/radar/radar.h"
#include "echopath/signal/echoes/echoes.h"

namespace echopath {

struct FrameNodes {
  std::vector<double> times;           // [num_nodes] s
  std::vector<TimeSampling> sampling;  // by transmitter
  int order = 1;                       // nodes per piece or, where is_exact, per chirp
  bool is_exact = false;               // every chirp has nodes; else there is one node for all where the order is 1

  // These rows [2, order] give the last two Chebyshev coefficients of a piece from its nodes, which measure what the
  // polynomial leaves out. They are empty for order 1 and for exact nodes.
  std::vector<double> tail;
  int num_pieces() const { return order > 1 && !is_exact ? static_cast<int>(times.size()) / order : 0; }
};

// Says which derivatives inside a chirp are wanted: the slope, or the second and the third too (TimeSampling).
enum class ChirpDerivatives { kFirst, kThird };
// Returns how many rows a chirp has that holds its value and these derivatives.
constexpr int rows_of_chirp(ChirpDerivatives derivatives) { return derivatives == ChirpDerivatives::kThird ? 4 : 2; }

// Returns one node, at `time` (s).
FrameNodes static_nodes(const Radar& radar, double time);
// Returns `order` Chebyshev-Lobatto nodes in each piece between the breakpoints (s, ascending) that lie inside the frame
// that starts at start_time. Derivatives are those of the same polynomial.
FrameNodes chebyshev_nodes(const Radar& radar, double start_time, const std::vector<double>& breakpoints, int order,
                           ChirpDerivatives derivatives = ChirpDerivatives::kThird);
// Returns the same nodes without their sampling, which is the costly part.
FrameNodes unsampled_chebyshev_nodes(const Radar& radar, double start_time, const std::vector<double>& breakpoints,
                                     int order);
// Returns `order` (odd) such nodes in every chirp of one transmitter, which alone has a sampling; the middle node is at the
// window centre.
FrameNodes exact_nodes(const Radar& radar, double start_time, int order, int transmitter,
                       ChirpDerivatives derivatives = ChirpDerivatives::kThird);
// Returns one node in each chirp of one transmitter, at its window centre, without a sampling.
FrameNodes centre_nodes(const Radar& radar, double start_time, int transmitter);
// Returns the sampling of rows that hold, for each node of centre_nodes, a value and then its derivatives: 1 for kFirst, 3
// for kThird. The rows of a chirp begin at chirp * (1 + derivatives).
TimeSampling derivative_sampling(int num_chirps, ChirpDerivatives derivatives);

}  // namespace echopath
