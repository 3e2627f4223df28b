#include "echopath/replay/time/posed_grids.h"

#include <utility>

namespace echopath {

PosedGrids::PosedGrids(const TimeGrids& grids, const Paths& paths, const Radar& radar, const PathPreparer& preparer)
    : grids_(grids), paths_(paths), radar_(radar), preparer_(preparer),
      polynomials_(static_cast<size_t>(grids.num_polynomials())) {}

// Poses only this `transmitter`, or all where it is -1.
std::shared_ptr<const PosedScenes> PosedGrids::scenes_at(const std::vector<double>& times, int transmitter) const {
  std::shared_ptr<PosedScenes> scenes = pose_at(*paths_.scene, radar_, preparer_.patches(), paths_.frame.transmitter, times);
  if (transmitter < 0) return scenes;
  for (PosedScene& posed : *scenes) posed.transmitters = {posed.transmitters[static_cast<size_t>(transmitter)]};
  return scenes;
}

PosedGrid PosedGrids::pose(const TimeGrid& grid) const {
  FrameNodes nodes = nodes_of(grid, radar_, grids_.start_time(), grids_.derivatives());
  PosedNodes posed(scenes_at(nodes.times, transmitter_of(grid)));
  return {std::move(nodes), std::move(posed), transmitter_of(grid)};
}

PosedNodes PosedGrids::pose(double time) const { return PosedNodes(scenes_at({time}, -1)); }

PosedNodes PosedGrids::pose(std::span<const double> times, std::span<const Radar> radars) const {
  auto scenes = std::make_shared<PosedScenes>();
  scenes->reserve(times.size());
  for (size_t i = 0; i < times.size(); ++i) {
    scenes->emplace_back(*paths_.scene, radars[i], preparer_.patches(), paths_.frame.transmitter, times[i]);
  }
  return PosedNodes(std::move(scenes));
}

const PosedGrid& PosedGrids::at_trace() const {
  return at_trace_.get([&] { return pose(grids_.still()); });
}

const TrialGrid& PosedGrids::trial(int polynomial) const {
  return kept(polynomial).trial.get([&] {
    const PolynomialGrid& grid = grids_.polynomial(polynomial);
    FrameNodes nodes = unsampled_chebyshev_nodes(radar_, grids_.start_time(), grid.cuts, grid.order);
    std::shared_ptr<const PosedScenes> scenes = scenes_at(nodes.times, -1);
    return TrialGrid{std::move(nodes), std::move(scenes)};
  });
}

const PosedGrid& PosedGrids::polynomial(int index) const {
  return kept(index).posed.get([&] {
    return PosedGrid{nodes_of(grids_.polynomial(index), radar_, grids_.start_time(), grids_.derivatives()),
                     PosedNodes(trial(index).scenes)};
  });
}

}  // namespace echopath
