#include "echopath/replay/posed/posed_nodes.h"

#include <utility>

namespace echopath {
namespace {

void store_mesh(const PosedScenes& scenes, uint32_t id, NodeRows& rows) {
  for (size_t node = 0; node < scenes.size(); ++node) {
    const Mat3& matrix = scenes[node].linear(id);
    for (int axis = 0; axis < 3; ++axis) {
      store(matrix.row(axis), rows, id, PointToPose::kLinear + 3 * static_cast<size_t>(axis), node);
    }
    store(scenes[node].translation(id), rows, id, PointToPose::kTranslation, node);
  }
  pad(rows, id, PointToPose::kNumMeshRows);
}

void store_antennas(const PosedScenes& scenes, bool of_receivers, NodeRows& rows) {
  const size_t num_antennas = scenes.front().antennas(of_receivers).size();
  rows.resize(num_antennas, LegToMeasure::kNumImageRows, scenes.size());
  for (size_t antenna = 0; antenna < num_antennas; ++antenna) {
    for (size_t node = 0; node < scenes.size(); ++node) {
      const PosedAntenna& posed = scenes[node].antennas(of_receivers)[antenna];
      store(posed.position, rows, antenna, LegToMeasure::kImagePosition, node);
      store(posed.boresight, rows, antenna, LegToMeasure::kBoresight, node);
    }
    pad(rows, antenna, LegToMeasure::kNumImageRows);
  }
}

void store_polarizations(const PosedScenes& scenes, bool of_receivers, PosedNodes& nodes) {
  NodeRows& rows = nodes.polarizations[of_receivers];
  const size_t num_antennas = scenes.front().antennas(of_receivers).size();
  rows.resize(num_antennas, ComponentsToFind::kNumPolarizationRows, scenes.size());
  for (size_t antenna = 0; antenna < num_antennas; ++antenna) {
    for (size_t node = 0; node < scenes.size(); ++node) {
      const Vec3& polarization = scenes[node].antennas(of_receivers)[antenna].polarization;
      store(polarization, rows, antenna, 0, node);
      nodes.is_upright = nodes.is_upright && polarization == Vec3::UnitZ();
    }
    pad(rows, antenna, ComponentsToFind::kNumPolarizationRows);
  }
}

}  // namespace

std::shared_ptr<PosedScenes> pose_at(const Scene& scene, const Radar& radar, const MeshesToPose& meshes, const Vec3& origin,
                                     std::span<const double> times) {
  auto scenes = std::make_shared<PosedScenes>();
  scenes->reserve(times.size());
  for (const double time : times) scenes->emplace_back(scene, radar, meshes, origin, time);
  return scenes;
}

PosedNodes::PosedNodes(std::shared_ptr<const PosedScenes> at_nodes) : scenes(std::move(at_nodes)) {
  meshes.resize(scenes->front().num_meshes(), PointToPose::kNumMeshRows, scenes->size());
  take_meshes(0);
  for (const bool of_receivers : {false, true}) {
    store_antennas(*scenes, of_receivers, antennas[of_receivers]);
    store_polarizations(*scenes, of_receivers, *this);
  }
}

void PosedNodes::take_meshes(size_t first) {
  const PosedScene& one = scenes->front();
  for (size_t place = first; place < one.num_posed(); ++place) store_mesh(*scenes, one.mesh_at(place), meshes);
}

}  // namespace echopath
