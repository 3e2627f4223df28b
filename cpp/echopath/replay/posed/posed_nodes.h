#pragma once
// Holds the scene and the radar at all nodes of a time grid: one PosedScene for each node, and the same values in rows for
// loops along the nodes.
#include <memory>
#include <span>
#include <vector>

#include "echopath/posed/posed_scene.h"
#include "echopath/replay/kernels/shared_leg_kernels.h"
#include "echopath/replay/posed/node_rows.h"

namespace echopath {

using PosedScenes = std::vector<PosedScene>;  // by node

// Poses the radar and these meshes of the scene at each of the times (s), as PosedScene does.
std::shared_ptr<PosedScenes> pose_at(const Scene& scene, const Radar& radar, const MeshesToPose& meshes, const Vec3& origin,
                                     std::span<const double> times);

struct PosedNodes {
  PosedNodes() = default;
  // The scenes are shared with whoever else looks at single nodes; there is at least one.
  explicit PosedNodes(std::shared_ptr<const PosedScenes> at_nodes);
  // Takes the meshes that the scenes have from place `first` on.
  void take_meshes(size_t first);

  std::shared_ptr<const PosedScenes> scenes;
  NodeRows meshes;            // of mesh IDs, PointToPose::MeshRow
  NodeRows antennas[2];       // of transmitters, of receivers; LegToMeasure::ImageRow
  NodeRows polarizations[2];  // of transmitters, of receivers; in the world, ComponentsToFind::PolarizationRow
  bool is_upright = true;     // every polarisation points along z at every node: across any direction it is the vertical one

  size_t size() const { return scenes ? scenes->size() : 0; }
  const PosedScene& at(size_t node) const { return (*scenes)[node]; }
};

inline void store(const Vec3& vector, NodeRows& rows, size_t entry, size_t first_row, size_t node) {
  for (int axis = 0; axis < 3; ++axis) rows.row(entry, first_row + static_cast<size_t>(axis))[node] = vector[axis];
}
inline Vec3 load(const NodeRows& rows, size_t entry, size_t first_row, size_t node) {
  return {rows.row(entry, first_row)[node], rows.row(entry, first_row + 1)[node], rows.row(entry, first_row + 2)[node]};
}
inline void pad(NodeRows& rows, size_t entry, size_t num_rows) {
  for (size_t row = 0; row < num_rows; ++row) rows.pad(entry, row);
}

}  // namespace echopath
