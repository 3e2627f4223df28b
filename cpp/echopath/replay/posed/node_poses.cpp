#include "echopath/replay/posed/node_poses.h"

namespace echopath {
namespace {

void store_meshes(std::span<const Instant> instants, uint32_t num_meshes, NodeRows& rows) {
  rows.resize(num_meshes, PointToPose::kNumMeshRows, instants.size());
  for (uint32_t id = 0; id < num_meshes; ++id) {
    for (size_t node = 0; node < instants.size(); ++node) {
      const Mat3& matrix = instants[node].rotation(id);
      for (int axis = 0; axis < 3; ++axis) {
        store(matrix.row(axis), rows, id, PointToPose::kLinear + 3 * static_cast<size_t>(axis), node);
      }
      store(instants[node].translation(id), rows, id, PointToPose::kTranslation, node);
    }
    pad(rows, id, PointToPose::kNumMeshRows);
  }
}

void store_antennas(std::span<const Instant> instants, bool of_receivers, NodeRows& rows) {
  const size_t num_antennas = antennas_of(instants.front(), of_receivers).size();
  rows.resize(num_antennas, LegToMeasure::kNumImageRows, instants.size());
  for (size_t antenna = 0; antenna < num_antennas; ++antenna) {
    for (size_t node = 0; node < instants.size(); ++node) {
      const PosedAntenna& posed = antennas_of(instants[node], of_receivers)[antenna];
      store(posed.position, rows, antenna, LegToMeasure::kImagePosition, node);
      store(posed.boresight, rows, antenna, LegToMeasure::kBoresight, node);
    }
    pad(rows, antenna, LegToMeasure::kNumImageRows);
  }
}

void store_polarizations(std::span<const Instant> instants, bool of_receivers, NodePoses& poses) {
  NodeRows& rows = poses.polarizations[of_receivers];
  const size_t num_antennas = antennas_of(instants.front(), of_receivers).size();
  rows.resize(num_antennas, ComponentsToFind::kNumPolarizationRows, instants.size());
  for (size_t antenna = 0; antenna < num_antennas; ++antenna) {
    for (size_t node = 0; node < instants.size(); ++node) {
      const Vec3& polarization = antennas_of(instants[node], of_receivers)[antenna].polarization;
      store(polarization, rows, antenna, 0, node);
      poses.is_upright = poses.is_upright && polarization == Vec3::UnitZ();
    }
    pad(rows, antenna, ComponentsToFind::kNumPolarizationRows);
  }
}

}  // namespace

NodePoses node_poses(std::span<const Instant> instants, uint32_t num_meshes) {
  NodePoses poses;
  store_meshes(instants, num_meshes, poses.meshes);
  for (const bool of_receivers : {false, true}) {
    store_antennas(instants, of_receivers, poses.antennas[of_receivers]);
    store_polarizations(instants, of_receivers, poses);
  }
  return poses;
}

}  // namespace echopath
