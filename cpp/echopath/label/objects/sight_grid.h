#pragma once
// Finds shares of a stratum by what directions in it meet: many directions where that changes, few elsewhere.
//
// The stratum's plane is cut into cells with a direction in each, and these into blocks of 4 x 4. One direction is looked at
// in each block, then all of the blocks whose neighbours met something else, and on from there along the border that these
// find. The other blocks count as what their one direction met. Directions lie at the places of a lattice in their cells
// (the row moves them along, the column across), so that no edge along the rows or columns runs through all of them at once.
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "echopath/trace/embree/packet.h"
#include "echopath/trace/launch/launch_directions.h"

namespace echopath {

class SightGrid {
 public:
  // Writes what the first `count` directions of a packet meet.
  using FindMet = std::function<void(const LaneVectors& directions, int count, uint32_t* met)>;
  static constexpr int kSide = 4;        // cells of a block
  static constexpr int kFewBlocks = 64;  // as many are looked at wholly
  static constexpr uint32_t kNothing = std::numeric_limits<uint32_t>::max();

  // `num_cells` is approximate.
  SightGrid(const Stratum& stratum, int64_t num_cells);
  // Looks at one direction of each block, or at all where there are few. Returns the share of them that met something.
  double start(const FindMet& find_met);
  // Looks at the blocks where what is met changes, or at all of them.
  void finish(const FindMet& find_met);
  void finish_everywhere(const FindMet& find_met);

  // Returns the number of cells that met each of `num_kinds`.
  std::vector<int64_t> counts(size_t num_kinds) const;
  double cell_angle() const { return cell_angle_; }  // sr

 private:
  enum class State : uint8_t { kUnseen, kQueued, kSeen };
  int64_t num_blocks() const { return int64_t{num_columns_} * num_rows_; }
  void direct(int64_t block, int cell, LaneValues& x, LaneValues& y, int lane) const;
  void look_at(const LaneValues& x, const LaneValues& y, int count, const FindMet& find_met, uint32_t* met) const;
  void look_at_first_cells(const FindMet& find_met);
  void see(int64_t block, const FindMet& find_met);
  void queue(int64_t block);
  void queue_changes();
  void queue_neighbours(int64_t block);

  LaunchDirections directions_;
  Eigen::Vector2d half_;  // half lengths of the domain
  bool is_disc_;
  int num_columns_, num_rows_;  // of blocks
  double cell_angle_;
  std::vector<uint32_t> first_met_;  // [block] what its one direction met
  std::vector<uint32_t> met_;        // [block, cell], of blocks that were seen
  std::vector<State> state_;         // [block]
  std::vector<int64_t> queue_;
};

}  // namespace echopath
