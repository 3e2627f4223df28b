#pragma once
// Paths of a block at all nodes, from the legs that they share: a path costs a sum of lengths, a product of factors and, where it is
// coherent, the filter of its launch cell; an array of N x M channels costs N + M legs.
#include "echopath/replay/amplitude.h"
#include "echopath/replay/chain_tables.h"

namespace echopath {

// Where the values of one channel go, [node, num_paths]: lengths in m, amplitudes in sqrt(W).
struct ChannelNodes {
  double* length;
  std::complex<double>* amplitude;
  size_t num_paths, first_path;  // places count from there

  void set(size_t node, size_t place, double length_there, std::complex<double> amplitude_there) const {
    const size_t at = node * num_paths + first_path + place;
    length[at] = length_there;
    amplitude[at] = amplitude_there;
  }
};

// Some channels [tx * num_rx + rx] for the antennas of the instants: one after the other from `first` on.
struct ChannelSpan {
  size_t first;
  std::span<const ChannelNodes> nodes;
};

// Keeps its memory from block to block; for one thread at a time.
class ChainEvaluation {
 public:
  // Writes the paths of the plan that do not stand among its others. The antennas must have no phase (has_phase).
  void operator()(const ChainPlan& plan, const Localiser& localise, const LevelView& level, const RadioConstants& radio,
                  const ChannelSpan& channels);

 private:
  struct Ends {
    size_t start, end;  // antennas of both
  };
  Ends ends_of(const ChainPlan::Chain& chain, size_t channel) const;
  PathToCombine path_of(const ChainPlan::Chain& chain, const Ends& ends, double scale);
  const double* image_of(const ChainPlan& plan, uint32_t leg, size_t antenna) const;
  void write_diffuse(const ChainPlan& plan, double scale, const ChannelSpan& channels);
  void write_coherent(const ChainPlan& plan, const Localiser& localise, const LevelView& level, const RadioConstants& radio,
                      const ChannelSpan& channels);
  void put(size_t place, const ChannelNodes& to) const;

  ChainTables tables_;
  NodeRows values_;  // of one path, PathToCombine::Row
  size_t num_receivers_ = 0;
};

// An antenna turns the phase of what it sends or receives, by direction.
bool has_phase(const Radar& radar);

}  // namespace echopath
