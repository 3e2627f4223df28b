#pragma once
// Sorts echoes by group and delay into tiles, the layout that the inner loops of synthesis read.
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "echopath/signal/echoes/echoes.h"

namespace echopath {

struct DriftClasses;

// Holds echoes sorted by group, drift and delay. Echoes that are neighbours in delay spread onto the same cells of the grid,
// so that their kernels are summed at once (cell moments), and the rows of one group stay in the cache. The delay that
// counts is the one in the middle of the frame. Where there are enough echoes, they are first divided into classes that
// drift alike over the frame, so that neighbours stay neighbours. An echo that still moves unlike its neighbours costs time,
// but does not change the result.
class EchoTiles {
 public:
  struct Tile {
    int64_t vector;  // the first of its vectors, as in TileAtChirps
    int count;       // echoes, at most TileAtChirps::kCapacity
    uint32_t group;
  };

  // Takes the echoes of `blocks`, which share one sampling. Echoes are ordered by delays in [0, longest_delay], which span
  // `num_cells` cells; delays beyond these limits count as the limit. Memory of the last call is used again. Where the
  // echoes are those of the last call as another channel sees them, their order is used again, too.
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
  // These tell which echoes were sorted last: echoes and groups of each block, and delays of a few echoes (s).
  std::vector<int64_t> sizes_;
  std::vector<std::vector<uint32_t>> groups_;
  std::vector<double> samples_;
  std::vector<Tile> tiles_;
  std::vector<int64_t> first_;       // [tiles], place of the first echo of each in the order
  std::unique_ptr<double[]> nodes_;  // with room for `num_values_`
  size_t num_values_ = 0;
};

}  // namespace echopath
