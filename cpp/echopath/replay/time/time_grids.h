#pragma once
// Lists the time grids that a frame offers: polynomials by their number of nodes, and grids with nodes in every chirp.
#include <vector>

#include "echopath/record/paths.h"
#include "echopath/replay/replay_settings.h"
#include "echopath/replay/time/grid_index.h"
#include "echopath/replay/time/time_grid.h"

namespace echopath {

// Polynomials stand in ascending order of their nodes. None has more nodes than evaluation in every chirp, and there is none
// at all where that was asked for. The grids do not change once they are made.
class TimeGrids {
 public:
  static constexpr int kHighestOrder = 32;
  TimeGrids(const Paths& paths, const Radar& radar, const ReplaySettings& settings);

  StillGrid still() const { return {trace_time_}; }
  size_t num_polynomials() const { return polynomials_.size(); }
  const PolynomialGrid& polynomial(GridIndex index) const { return polynomials_[index.number()]; }
  ChirpGrid chirps(int transmitter) const { return {transmitter}; }
  SampleGrid samples(int transmitter) const { return {transmitter, sample_order_}; }
  int64_t num_sample_nodes() const { return int64_t{num_chirps_} * sample_order_; }  // for one transmitter

  double start_time() const { return start_time_; }  // s, of the frame
  ChirpDerivatives derivatives() const { return derivatives_; }
  // Returns the first polynomial after `index` that has at least this order, or whose pieces are of the other kind.
  GridIndex next_polynomial(GridIndex index, double needed_order) const;

 private:
  void find_polynomials(const Scene& scene, const Radar& radar);

  double start_time_, trace_time_;  // s
  int num_chirps_, sample_order_;
  ChirpDerivatives derivatives_;
  std::vector<PolynomialGrid> polynomials_;
};

}  // namespace echopath
