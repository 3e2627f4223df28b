#pragma once
// Diffuse paths of a block at all nodes, from the legs that they share: a path costs a sum of lengths and a product of
// factors, an array of N x M channels N + M legs.
#include "echopath/replay/chain_plan.h"
#include "echopath/replay/amplitude.h"

namespace echopath {

// Where the values of one channel go, [node, path]: lengths in m, amplitudes in sqrt(W).
struct ChannelNodes {
  double* length;
  std::complex<double>* amplitude;
};

// channels [tx * num_rx + rx] for the antennas of the instants; `num_paths` of the block, of which the chains of the plan are
// written. The antennas must have no phase (has_phase).
void evaluate_chains(const ChainPlan& plan, const Localiser& localise, std::span<const Instant> instants,
                     const RadioConstants& radio, size_t num_paths, std::span<const ChannelNodes> channels);

// An antenna turns the phase of what it sends or receives, by direction.
bool has_phase(const Radar& radar);

}  // namespace echopath
