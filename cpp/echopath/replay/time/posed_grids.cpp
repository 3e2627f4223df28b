#include "echopath/replay/time/posed_grids.h"

#include <utility>

#include "echopath/base/errors.h"

namespace echopath {
namespace {

// Keeps all where `transmitter` is -1.
void keep_one_transmitter(PosedScene& posed, int transmitter) {
  if (transmitter >= 0) posed.transmitters = {posed.transmitters[transmitter]};
}

// Returns what a mesh takes at one node: its matrices and place in PosedScene, its rows in PosedNodes, and the vertices and
// normals of a mesh that deforms.
int64_t bytes_of_pose(const Scene& scene, uint32_t mesh) {
  size_t bytes = 2 * sizeof(Mat3) + sizeof(Vec3) + PointToPose::kNumMeshRows * sizeof(double);
  if (scene.node_of(mesh).deformation) bytes += 2 * sizeof(Vec3) * scene.node_of(mesh).mesh->vertices().size();
  return static_cast<int64_t>(bytes);
}

}  // namespace

PartlyPosedGrid::PartlyPosedGrid(PosedGrid grid, std::shared_ptr<PosedScenes> scenes, const Scene& scene,
                                 const std::vector<SurfacePatch>& patches)
    : grid_(std::move(grid)), scenes_(std::move(scenes)), scene_(scene), patches_(patches),
      places_(std::make_shared<const MeshPlaces>(scene.meshes().size())) {}

const PosedGrid& PartlyPosedGrid::with(std::span<const uint32_t> meshes) {
  const size_t first = places_->meshes.size();
  auto places = std::make_shared<MeshPlaces>(*places_);
  for (const uint32_t mesh : meshes) places->add(mesh);
  if (places->meshes.size() == first) return grid_;
  const PlacingNodes nodes(scene_, std::span(places->meshes).subspan(first));
  for (PosedScene& scene : *scenes_) scene.add(places, nodes, patches_);
  grid_.posed.take_meshes(first);
  for (size_t place = first; place < places->meshes.size(); ++place)
    num_bytes_ += std::ssize(*scenes_) * bytes_of_pose(scene_, places->meshes[place]);
  places_ = std::move(places);
  return grid_;
}

PosedGrids::PosedGrids(const TimeGrids& grids, const Paths& paths, const Radar& radar, const PathPreparer& preparer)
    : grids_(grids), paths_(paths), radar_(radar), preparer_(preparer) {}

std::shared_ptr<const PosedScenes> PosedGrids::scenes_at(std::span<const double> times) const {
  return pose_at(*paths_.scene, radar_, preparer_.meshes(), paths_.frame.transmitter, times);
}

PartlyPosedGrid PosedGrids::pose_partly(const TimeGrid& grid) const {
  return pose_partly(nodes_of(grid, radar_, grids_.start_time(), grids_.derivatives()), transmitter_of(grid));
}

PartlyPosedGrid PosedGrids::pose_partly(FrameNodes nodes, int transmitter) const {
  auto scenes = std::make_shared<PosedScenes>();
  scenes->reserve(nodes.times.size());
  for (const double time : nodes.times) {
    scenes->emplace_back(*paths_.scene, radar_, paths_.frame.transmitter, time);
    keep_one_transmitter(scenes->back(), transmitter);
  }
  PosedNodes posed(scenes);
  return {{std::move(nodes), std::move(posed), transmitter}, std::move(scenes), *paths_.scene, preparer_.meshes().patches};
}

// Refuses times outside of the motion of any node that takes part and is there at that time, also where no path touches it:
// that must not depend on what was hit.
void PosedGrids::require_times(std::span<const double> times) const {
  for (const double time : times) paths_.scene->require_times(time, time);
}

PosedNodes PosedGrids::pose(std::span<const double> times) const {
  require_times(times);
  return PosedNodes(scenes_at(times));
}

PosedNodes PosedGrids::pose(std::span<const double> times, std::span<const Radar> radars) const {
  require_times(times);
  auto scenes = std::make_shared<PosedScenes>();
  scenes->reserve(times.size());
  for (size_t i = 0; i < times.size(); ++i)
    scenes->emplace_back(*paths_.scene, radars[i], preparer_.meshes(), paths_.frame.transmitter, times[i]);
  return PosedNodes(std::move(scenes));
}

void PosedGrids::pose_still() {
  if (still_) return;
  FrameNodes nodes = nodes_of(grids_.still(), radar_, grids_.start_time(), grids_.derivatives());
  PosedNodes posed(scenes_at(nodes.times));
  still_.emplace(PosedGrid{std::move(nodes), std::move(posed)});
}

PosedGrids::Polynomial& PosedGrids::kept(GridIndex polynomial) {
  const auto found = polynomials_.find(polynomial);
  if (found != polynomials_.end()) return found->second;
  const PolynomialGrid& grid = grids_.polynomial(polynomial);
  FrameNodes nodes = unsampled_chebyshev_nodes(radar_, grids_.start_time(), grid.cuts, grid.order);
  return polynomials_.emplace(polynomial, Polynomial{pose_partly(std::move(nodes), -1)}).first->second;
}

const PosedGrid& PosedGrids::trial(GridIndex polynomial) {
  Polynomial& own = kept(polynomial);
  if (!own.is_tried) own.grid.with(meshes_of_cuts(polynomial.cuts()));
  own.is_tried = true;
  return own.grid.get();
}

// Paths over meshes with the radar's cuts alone touch no others.
bool PosedGrids::is_whole(GridIndex polynomial) const {
  const auto found = polynomials_.find(polynomial);
  return polynomial.cuts() == MotionCuts::kOfRadar && found != polynomials_.end() && found->second.is_tried;
}

void PosedGrids::pose_polynomial(GridIndex polynomial, std::span<const uint32_t> meshes) {
  PartlyPosedGrid& grid = kept(polynomial).grid;
  if (grid.with(meshes).nodes.sampling.empty()) {
    grid.set_sampling(nodes_of(grids_.polynomial(polynomial), radar_, grids_.start_time(), grids_.derivatives()).sampling);
  }
}

const PosedGrid& PosedGrids::polynomial(GridIndex polynomial) const {
  const auto found = polynomials_.find(polynomial);
  const bool is_posed = found != polynomials_.end() && !found->second.grid.get().nodes.sampling.empty();
  require(is_posed, "polynomial", "must have been posed, number", polynomial.number());
  return found->second.grid.get();
}

std::vector<uint32_t> PosedGrids::meshes_of_cuts(uint32_t cuts) const {
  std::vector<uint32_t> meshes;
  for (uint32_t mesh = 0; mesh < paths_.scene->meshes().size(); ++mesh) {
    if (grids_.cuts().of_mesh(mesh) == cuts) meshes.push_back(mesh);
  }
  return meshes;
}

}  // namespace echopath
