#pragma once
// Meshes and antennas at all nodes of a level, in rows that loops along nodes read.
#include <span>

#include "echopath/replay/kernels/chain_kernels.h"
#include "echopath/replay/posed/instant.h"
#include "echopath/replay/posed/node_rows.h"

namespace echopath {

struct NodePoses {
  NodeRows meshes;        // of mesh IDs, PointToPose::MeshRow
  NodeRows antennas[2];   // of transmitters, of receivers; LegToMeasure::ImageRow
  NodeRows polarizations[2];  // likewise, in the world: ComponentsToFind::PolarizationRow
  bool is_upright = true;     // every polarisation points along z at every node: across any direction it is the vertical one
};
NodePoses node_poses(std::span<const Instant> instants, uint32_t num_meshes);

inline const std::vector<PosedAntenna>& antennas_of(const Instant& instant, bool of_receivers) {
  return of_receivers ? instant.receivers : instant.transmitters;
}

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
