#pragma once
// Lists the time grids that a frame offers: polynomials by their number of nodes, and grids with nodes in every chirp.
#include <vector>

#include "echopath/record/paths.h"
#include "echopath/replay/replay_settings.h"
#include "echopath/replay/time/grid_index.h"
#include "echopath/replay/time/motion_cuts.h"
#include "echopath/replay/time/time_grid.h"

namespace echopath {

// Polynomials of a set of cuts stand in ascending order of their nodes. None has more nodes than evaluation in every chirp,
// and there is none at all where that was asked for. Only `join` adds grids; those that exist keep their index and do not
// change.
class TimeGrids {
 public:
  static constexpr int kHighestOrder = 32;
  TimeGrids(const Paths& paths, const Radar& radar, const ReplaySettings& settings);

  StillGrid still() const { return {trace_time_}; }
  const MotionCuts& cuts() const { return cuts_; }
  // Adds the polynomials of the union of two sets of cuts, unless it has them, and returns its index.
  uint32_t join(uint32_t a, uint32_t b);
  size_t num_polynomials(uint32_t cuts) const { return polynomials_[cuts].size(); }
  std::vector<GridIndex> polynomials() const;  // of all sets of cuts, in their order
  const PolynomialGrid& polynomial(GridIndex index) const { return polynomials_[index.cuts()][index.number()]; }
  // Returns the polynomial of the same order in the pieces of other cuts, to which its own belong; none where that has too
  // many nodes. Grids that are no polynomials stay as they are.
  GridIndex in_cuts(GridIndex index, uint32_t cuts) const;
  ChirpGrid chirps(int transmitter) const { return {transmitter}; }
  SampleGrid samples(int transmitter) const { return {transmitter, sample_order_}; }
  int64_t num_sample_nodes() const { return int64_t{num_chirps_} * sample_order_; }  // for one transmitter

  double start_time() const { return start_time_; }  // s, of the frame
  ChirpDerivatives derivatives() const { return derivatives_; }
  // Returns the first polynomial of the same cuts after `index` that has at least this order, or whose pieces are of the
  // other kind.
  GridIndex next_polynomial(GridIndex index, double needed_order) const;

 private:
  void add_polynomials();
  std::vector<PolynomialGrid> polynomials_of(const Cuts& cuts) const;

  double start_time_, trace_time_, frame_duration_;  // s
  int num_chirps_, sample_order_;
  ChirpDerivatives derivatives_;
  bool has_polynomials_;
  MotionCuts cuts_;
  std::vector<std::vector<PolynomialGrid>> polynomials_;  // by set of cuts
};

}  // namespace echopath
