#pragma once
// Keeps echoes in the order of their groups and delays, in the layout of the inner loops.
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "echopath/signal/echoes/echoes.h"

namespace echopath {

struct DriftClasses;

// Neighbours in delay share cells of the grid, where their kernels are summed at once (cell moments), and the rows of a
// group stay in the cache. Delays are compared in the middle of the frame, among echoes that drift alike over it, where
// there are enough of them. An echo that moves otherwise than its neighbours mixes the order, which costs only time.
class EchoTiles {
 public:
  struct Tile {
    int64_t vector;  // the first of its vectors, as in TileAtChirps
    int count;       // echoes, at most TileAtChirps::kCapacity
    uint32_t group;
  };

  // Takes the echoes of `blocks`, which share one sampling. Delays in [0, longest_delay], a span of `num_cells` cells, are
  // told apart, others are not. Memory is used again, and so is the order where the echoes are those of the last call as
  // another channel sees them.
  void assign(std::span<const Echoes> blocks, int num_groups, double longest_delay, int num_cells);

  // Sorts the echoes of the next call, whatever came before: results must not depend on other work of the process.
  void forget() { sizes_.clear(); }

  int num_nodes() const { return num_nodes_; }
  const std::vector<Tile>& tiles() const { return tiles_; }
  const double* nodes(const Tile& tile) const;
  size_t num_bytes() const { return sizeof(double) * num_values_ + sizeof(uint64_t) * 2 * order_.capacity(); }  // nearly all

 private:
  void set_bits(std::span<const Echoes> blocks, int num_groups, int num_drifts);
  void find_keys(std::span<const Echoes> blocks, double longest_delay, const DriftClasses& drifts);
  void sort(std::span<const Echoes> blocks, int num_groups, double longest_delay, int num_cells);
  bool fits(std::span<const Echoes> blocks, double cell) const;
  void remember(std::span<const Echoes> blocks);
  void cut();
  void make_room();
  void gather(std::span<const Echoes> blocks);

  int num_nodes_ = 0;
  // The bits of a key are, from the highest: group, drift, delay, block, echo in the block.
  int local_bits_ = 0, index_bits_ = 0, delay_bits_ = 0, drift_bits_ = 0, group_bits_ = 0;
  int group_shift() const { return index_bits_ + delay_bits_ + drift_bits_; }
  std::vector<uint64_t> order_, spare_order_;  // keys of all echoes, and room to sort them
  // What was sorted: echoes and groups of each block, and delays of a few echoes (s).
  std::vector<int64_t> sizes_;
  std::vector<std::vector<uint32_t>> groups_;
  std::vector<double> samples_;
  std::vector<Tile> tiles_;
  std::vector<int64_t> first_;       // [tiles], place of the first echo of each in the order
  std::unique_ptr<double[]> nodes_;  // with room for `num_values_`
  size_t num_values_ = 0;
};

}  // namespace echopath
