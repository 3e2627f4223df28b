#pragma once
// Launch cells of the coherent paths of a block, found by what these paths share.
#include "echopath/replay/chain_tables.h"
#include "echopath/replay/launch_cell.h"

namespace echopath {

// A launch cell on a mesh that moves rigidly.
struct RigidCell {
  CellShape shape;
  Vec3 tangent[2];         // T_a in the mesh's frame, m
  double root_area = 0.0;  // of curved cells: sqrt(|T_1 x T_2| density), m sr^-1/2
};

class TraceCells {
 public:
  // All must outlive it.
  TraceCells(const ChainPlan& plan, const Localiser& localise, const PosedPoints& points);
  RigidCell operator()(const ChainPlan::Chain& chain) const;

 private:
  struct Arrival {
    double length;    // m, unfolded, from the mean transmitter
    Vec3 direction;   // of travel, unit
  };
  Arrival arrival_of(const ChainPlan::Chain& chain) const;
  CellTangents flat_tangents(const ChainPlan::Chain& chain, const PosedHit& hit, double density) const;

  const ChainPlan& plan_;
  const Localiser& localise_;
  const PosedPoints& points_;
  std::vector<Vec3> origin_;  // [image] of the mean transmitter at the trace, m
};

}  // namespace echopath
