#pragma once
// Poses the scene at the nodes of time grids.
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "echopath/replay/posed/local_paths.h"
#include "echopath/replay/posed/posed_nodes.h"
#include "echopath/replay/time/time_grids.h"

namespace echopath {

// Holds the nodes of a time grid and the scene posed at them.
struct PosedGrid {
  FrameNodes nodes;
  PosedNodes posed;
  int transmitter = -1;  // the only one that is posed; -1: all are
};

// Poses the meshes of a grid when paths first need them.
class PartlyPosedGrid {
 public:
  // `scenes` are the posed scenes of `grid` and have no meshes yet. The scene and the patches must outlive it.
  PartlyPosedGrid(PosedGrid grid, std::shared_ptr<PosedScenes> scenes, const Scene& scene,
                  const std::vector<SurfacePatch>& patches);
  // Poses those of these meshes that are not posed yet, and returns the grid. Raises what PosedScene does.
  const PosedGrid& with(std::span<const uint32_t> meshes);
  const PosedGrid& get() const { return grid_; }
  void set_sampling(std::vector<TimeSampling> sampling) { grid_.nodes.sampling = std::move(sampling); }
  int64_t num_bytes() const { return num_bytes_; }  // of what its meshes take, nearly all

 private:
  PosedGrid grid_;
  std::shared_ptr<PosedScenes> scenes_;
  const Scene& scene_;
  const std::vector<SurfacePatch>& patches_;
  std::shared_ptr<const MeshPlaces> places_;
  int64_t num_bytes_ = 0;
};

// Keeps the grid of the time of the trace and those of polynomials, which are posed before they are used; grids of chirps,
// which are large, belong to the caller. Its const functions are thread-safe. Those that pose raise what PosedScene does.
class PosedGrids {
 public:
  // All arguments must outlive it.
  PosedGrids(const TimeGrids& grids, const Paths& paths, const Radar& radar, const PathPreparer& preparer);

  void pose_still();
  // Poses the meshes of a polynomial's cuts to try their motions at its nodes, which may have no sampling yet.
  const PosedGrid& trial(GridIndex polynomial);
  // Returns whether all meshes that paths of this polynomial can touch are posed, because motions were tried there.
  bool is_whole(GridIndex polynomial) const;
  // Makes polynomial() the grid of these meshes and those that it has already: most polynomials serve a few paths.
  void pose_polynomial(GridIndex polynomial, std::span<const uint32_t> meshes);

  // These return grids that have been posed.
  const PosedGrid& still() const { return still_.value(); }
  const PosedGrid& polynomial(GridIndex polynomial) const;

  PartlyPosedGrid pose_partly(const TimeGrid& grid) const;
  PosedNodes pose(std::span<const double> times) const;  // s
  // Poses at each of the times (s) the antennas of the radar of that time, which must outlive the result.
  PosedNodes pose(std::span<const double> times, std::span<const Radar> radars) const;

 private:
  struct Polynomial {
    PartlyPosedGrid grid;
    bool is_tried = false;  // it has the meshes of its cuts
  };
  void require_times(std::span<const double> times) const;
  std::shared_ptr<const PosedScenes> scenes_at(std::span<const double> times) const;
  PartlyPosedGrid pose_partly(FrameNodes nodes, int transmitter) const;
  Polynomial& kept(GridIndex polynomial);
  std::vector<uint32_t> meshes_of_cuts(uint32_t cuts) const;

  const TimeGrids& grids_;
  const Paths& paths_;
  const Radar& radar_;
  const PathPreparer& preparer_;
  std::optional<PosedGrid> still_;
  std::map<GridIndex, Polynomial> polynomials_;
};

}  // namespace echopath
