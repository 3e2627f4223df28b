#pragma once
// Paths of a block at all nodes, from the legs that they share: a path costs a sum of lengths, a product of factors and, where it is
// coherent, the filter of its launch cell; an array of N x M channels costs N + M legs.
#include "echopath/replay/amplitude.h"
#include "echopath/replay/chain_tables.h"

namespace echopath {

// Where the values of one channel go, [node, path]: lengths in m, amplitudes in sqrt(W).
struct ChannelNodes {
  double* length;
  std::complex<double>* amplitude;
};

// Keeps its memory from block to block; for one thread at a time.
class ChainEvaluation {
 public:
  // channels [tx * num_rx + rx] for the antennas of the instants; `num_paths` of the block, of which those of the plan are
  // written that do not stand among its others. The antennas must have no phase (has_phase).
  void operator()(const ChainPlan& plan, const Localiser& localise, const LevelView& level, const RadioConstants& radio,
                  size_t num_paths, std::span<const ChannelNodes> channels);

 private:
  struct Ends {
    size_t start, end;  // antennas of both
  };
  Ends ends_of(const ChainPlan::Chain& chain, size_t channel) const;
  PathToCombine path_of(const ChainPlan::Chain& chain, const Ends& ends, double scale);
  const double* image_of(const ChainPlan& plan, uint32_t leg, size_t antenna) const;
  void write_diffuse(const ChainPlan& plan, double scale, size_t num_paths, std::span<const ChannelNodes> channels);
  void write_coherent(const ChainPlan& plan, const Localiser& localise, const LevelView& level, const RadioConstants& radio,
                      size_t num_paths, std::span<const ChannelNodes> channels);
  void put(size_t place, size_t num_paths, const ChannelNodes& to) const;

  ChainTables tables_;
  NodeRows values_;  // of one path, PathToCombine::Row
  size_t num_receivers_ = 0;
};

// An antenna turns the phase of what it sends or receives, by direction.
bool has_phase(const Radar& radar);

}  // namespace echopath
