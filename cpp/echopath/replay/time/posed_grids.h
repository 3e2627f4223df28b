#pragma once
// Poses the scene at the nodes of time grids.
#include <memory>
#include <span>
#include <vector>

#include "echopath/base/memory/lazy.h"
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

// Holds a polynomial whose order is tried on meshes: its nodes without their sampling, which is the costly part.
struct TrialGrid {
  FrameNodes nodes;
  std::shared_ptr<const PosedScenes> scenes;
};

// Poses the meshes of a grid when paths first need them.
class PartlyPosedGrid {
 public:
  // `scenes` are the posed scenes of `grid` and have no meshes yet. The scene and the patches must outlive it.
  PartlyPosedGrid(PosedGrid grid, std::shared_ptr<PosedScenes> scenes, const Scene& scene,
                  const std::vector<SurfacePatch>& patches);
  // Poses those of these meshes that are not posed yet, and returns the grid. Raises what PosedScene does.
  const PosedGrid& with(std::span<const uint32_t> meshes);
  int64_t num_bytes() const { return num_bytes_; }  // of what its meshes take, nearly all

 private:
  PosedGrid grid_;
  std::shared_ptr<PosedScenes> scenes_;
  const Scene& scene_;
  const std::vector<SurfacePatch>& patches_;
  std::shared_ptr<const MeshPlaces> places_;
  int64_t num_bytes_ = 0;
};

// Poses the scene at the nodes of grids on request. The grid at the time of the trace and the grids of polynomials are kept.
// Of a polynomial all meshes are posed at once, or further ones with each pose_polynomial(). Grids of chirps, which are
// large, belong to the caller. Its const functions are thread-safe, except is_whole().
class PosedGrids {
 public:
  // All arguments must outlive it.
  PosedGrids(const TimeGrids& grids, const Paths& paths, const Radar& radar, const PathPreparer& preparer);

  const PosedGrid& at_trace() const;
  const PosedGrid& polynomial(int index) const;
  // Returns whether all meshes are posed at the nodes of a polynomial, because motions were tried there or it was asked for.
  // To be called while no other thread uses the grid.
  bool is_whole(int polynomial) const;
  // Makes polynomial() the grid of these meshes and those of earlier calls alone, unless it is whole: most polynomials
  // serve a few paths. To be called while no other thread uses the grid. Raises what PosedScene does.
  void pose_polynomial(int index, std::span<const uint32_t> meshes);
  const TrialGrid& trial(int polynomial) const;
  // Raises what PosedScene does.
  PartlyPosedGrid pose_partly(const TimeGrid& grid) const;
  PosedNodes pose(std::span<const double> times) const;  // s
  // Poses at each of the times (s) the antennas of the radar of that time, which must outlive the result.
  PosedNodes pose(std::span<const double> times, std::span<const Radar> radars) const;

 private:
  struct Polynomial {
    Lazy<TrialGrid> trial;
    Lazy<PosedGrid> posed;
    std::unique_ptr<PartlyPosedGrid> partly;
    const PosedGrid* of_meshes = nullptr;  // of `partly`
  };
  std::shared_ptr<const PosedScenes> scenes_at(std::span<const double> times) const;
  const Polynomial& kept(int polynomial) const { return polynomials_[static_cast<size_t>(polynomial) - 1]; }

  const TimeGrids& grids_;
  const Paths& paths_;
  const Radar& radar_;
  const PathPreparer& preparer_;
  Lazy<PosedGrid> at_trace_;
  std::vector<Polynomial> polynomials_;
};

}  // namespace echopath
