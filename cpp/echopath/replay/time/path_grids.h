#pragma once
// Finds the time grid that follows a path: it begins with the motion of the meshes that the path touches, and says how to go
// on.
#include <vector>

#include "echopath/replay/time/posed_grids.h"

namespace echopath {

// Names a path that a polynomial did not follow.
struct UnfollowedPath {
  int64_t path;
  // Orders at which polynomials would follow it; 0 where this one does.
  double order_for_length = 0.0, order_for_amplitude = 0.0;
  bool is_turned = false;  // the surface at an end of it shows its other side within the frame
  // The path needs no other polynomial: all such paths together are below the rounding of the strongest path.
  bool is_negligible = false;
};

// Says how to go on with such a path.
struct NextGrid {
  GridIndex grid;
  bool by_chirp;  // lengths follow that polynomial, amplitudes are evaluated in every chirp
};

// The constructor finds everything; after that many threads may read.
class PathGrids {
 public:
  // The record, the radar and `grids` must outlive it; motions are tried on `posed`. `grids` get the cuts of all paths.
  // `wavenumber` is in rad/m, `phase_tolerance` in rad. Raises what motions raise.
  PathGrids(const Paths& paths, const Radar& radar, TimeGrids& grids, PosedGrids& posed, double wavenumber,
            double phase_tolerance);

  const TimeGrids& grids() const { return grids_; }
  GridIndex first(int64_t path) const;
  NextGrid next(const UnfollowedPath& path, GridIndex polynomial) const;

 private:
  GridIndex first_of_mesh(uint32_t mesh_id, double turn_rate, PosedGrids& posed) const;
  bool is_quick_enough(GridIndex polynomial, double turn_rate) const;
  bool follows(const PosedGrid& trial, uint32_t mesh_id) const;
  bool stays_in_beam_where_nearest(const PosedGrid& trial, uint32_t mesh_id) const;
  void join_cuts(TimeGrids& grids) const;
  GridIndex first_in_joined_cuts(int64_t path) const;
  struct Range;
  Range range_of(int64_t path) const;
  template <class Add>
  void visit_grids(int64_t path, const Add& add) const;

  const Paths& paths_;
  const TimeGrids& grids_;
  double wavenumber_, phase_tolerance_, sharpness_;
  int num_chirps_;
  bool radar_moves_;
  std::vector<GridIndex> of_mesh_;  // by mesh ID: the first that follows its motion
  bool are_cuts_of_radar_ = true;   // those of all meshes
};

}  // namespace echopath
