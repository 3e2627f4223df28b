#pragma once
// Finds the launch cells of the coherent paths of a block from what these paths share.
#include "echopath/replay/evaluate/shared_leg_tables.h"
#include "echopath/replay/factors/launch_cell.h"

namespace echopath {

// Describes a launch cell and where it lies.
struct PlacedCell {
  CellShape shape;
  Vec3 tangent[2];         // T_a, m: in the mesh's frame where the mesh is rigid, else in the world
  double root_area = 0.0;  // of curved cells: sqrt(|T_1 x T_2| density), m sr^-1/2
};

class TraceCells {
 public:
  // All arguments must outlive it.
  TraceCells(const SharedLegPlan& plan, const PathPreparer& preparer, const PosedPoints& points);
  bool may_stretch(uint32_t mesh_id) const { return preparer_.may_stretch(mesh_id); }
  // Returns the cell on a mesh that moves rigidly; it is the same at all times.
  PlacedCell on_rigid(const SharedLegPlan::ChainPath& chain) const;
  // Returns the cell on a mesh that may stretch, at each of the nodes.
  std::vector<PlacedCell> on_stretching(const SharedLegPlan::ChainPath& chain, const PosedNodes& nodes) const;

 private:
  struct Arrival {
    double length;   // m, unfolded, from the mean transmitter
    Vec3 direction;  // of travel, unit
  };
  Arrival arrival_of(const SharedLegPlan::ChainPath& chain) const;
  CellTangents flat_tangents(const SharedLegPlan::ChainPath& chain, const PosedHit& hit, double density) const;
  const Hit& hit_of(const SharedLegPlan::ChainPath& chain) const { return plan_.points[plan_.legs[chain.end].point]; }
  bool has_cell(const SharedLegPlan::ChainPath& chain) const;
  double density_of(const SharedLegPlan::ChainPath& chain) const;  // rays per sr
  // Returns the cell that was recorded behind a curved bounce, or null where the chain is flat.
  const std::array<float, 7>* curved_cell_of(const SharedLegPlan::ChainPath& chain) const;

  const SharedLegPlan& plan_;
  const PathPreparer& preparer_;
  const PosedPoints& points_;
  std::vector<ImageAtTrace> images_;  // [image]
};

}  // namespace echopath
