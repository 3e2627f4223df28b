#pragma once
// Finds shares of a stratum by what directions in it meet: many directions where that changes, few elsewhere.
//
// The stratum's plane is cut into cells with a direction in each, and these into blocks of 4 x 4. First one direction is
// looked at in each block, or in each quarter of it, or all where there are few blocks; then all of the blocks where
// neighbours among these met different things, and on from there along the border that they find. In the other blocks the
// first directions stand for the cells about them. The first directions, and those of all cells, each lie at the places of a
// lattice of their own (the row moves them along, the column across), so that no edge along the rows or columns runs through
// all of a column or row at once.
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "echopath/trace/embree/packet.h"
#include "echopath/trace/launch/launch_directions.h"

namespace echopath {

class VisibilityGrid {
 public:
  // Writes what the first `count` directions of a packet meet.
  using FindMet = std::function<void(const LaneVectors& directions, int count, uint32_t* met)>;
  static constexpr int kSide = 4;           // cells of a block
  static constexpr int kFewestFirst = 512;  // directions that are looked at first, if there are as many
  static constexpr uint32_t kNothing = std::numeric_limits<uint32_t>::max();

  // `num_cells` is approximate.
  VisibilityGrid(const Stratum& stratum, int64_t num_cells);
  // Looks at the first directions. Returns the share of them that met something.
  double start(const FindMet& find_met);
  // Returns what all of the first directions met that met anything, if it is the same, and they are `least` or more.
  std::optional<uint32_t> only_met(int64_t least) const;
  // Looks at the blocks where what is met changes, or at all of them.
  void finish(const FindMet& find_met);
  void finish_everywhere(const FindMet& find_met);

  // Returns the number of cells that met each of `num_kinds`.
  std::vector<int64_t> counts(size_t num_kinds) const;
  double cell_angle() const { return cell_angle_; }  // sr

 private:
  enum class State : uint8_t { kUnseen, kQueued, kSeen };
  int64_t num_blocks() const { return int64_t{num_columns_} * num_rows_; }
  int64_t num_first_rows() const { return int64_t{num_rows_} * kSide / step_; }
  int64_t num_first_columns() const { return int64_t{num_columns_} * kSide / step_; }
  void direct(int64_t row, int64_t column, int size, int lane, LaneValues& x, LaneValues& y) const;
  void look_at(const LaneValues& x, const LaneValues& y, int count, const FindMet& find_met, uint32_t* met) const;
  void see(int64_t block, const FindMet& find_met);
  void queue(int64_t block);
  void queue_changes();
  void queue_neighbours(int64_t block);

  LaunchDirections directions_;
  Eigen::Vector2d half_;  // half lengths of the domain
  bool is_disc_;
  int num_columns_, num_rows_;  // of blocks
  int step_ = kSide;            // cells, 4, 2 or 1, on a side of the square for which a first direction stands
  double cell_angle_;
  std::vector<uint32_t> first_met_;  // [first row, first column] what the first directions met
  std::vector<uint32_t> met_;        // [block, cell], of blocks that were seen
  std::vector<State> state_;         // [block]
  std::vector<int64_t> queue_;
};

}  // namespace echopath
