#pragma once
// Poses the scene at the nodes of time grids.
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

// Keeps the grid of the time of the trace and those of polynomials, which are posed before they are used; grids of chirps,
// which are large, belong to the caller. Its const functions are thread-safe. All others raise what PosedScene does.
class PosedGrids {
 public:
  // All arguments must outlive it.
  PosedGrids(const TimeGrids& grids, const Paths& paths, const Radar& radar, const PathPreparer& preparer);

  void pose_still();
  // Poses all meshes at the nodes of a polynomial.
  void pose_polynomial(GridIndex polynomial);
  // Makes polynomial() the grid of these meshes and those of earlier calls alone: most polynomials serve a few paths.
  void pose_polynomial(GridIndex polynomial, std::span<const uint32_t> meshes);
  // Poses all meshes to try their motions.
  const TrialGrid& trial(GridIndex polynomial);

  // These return grids that have been posed.
  const PosedGrid& still() const { return still_.value(); }
  const PosedGrid& polynomial(GridIndex polynomial) const;
  // Returns whether all meshes are posed at the nodes of a polynomial, because motions were tried there or it was asked for.
  bool is_whole(GridIndex polynomial) const { return kept(polynomial).trial.has_value(); }

  PartlyPosedGrid pose_partly(const TimeGrid& grid) const;
  PosedNodes pose(std::span<const double> times) const;  // s
  // Poses at each of the times (s) the antennas of the radar of that time, which must outlive the result.
  PosedNodes pose(std::span<const double> times, std::span<const Radar> radars) const;

 private:
  struct Polynomial {
    std::optional<TrialGrid> trial;
    std::optional<PosedGrid> whole;
    std::optional<PartlyPosedGrid> partly;
    const PosedGrid* posed = nullptr;  // one of the two
  };
  std::shared_ptr<const PosedScenes> scenes_at(std::span<const double> times) const;
  const Polynomial& kept(GridIndex polynomial) const { return polynomials_[polynomial.number()]; }
  Polynomial& kept(GridIndex polynomial) { return polynomials_[polynomial.number()]; }

  const TimeGrids& grids_;
  const Paths& paths_;
  const Radar& radar_;
  const PathPreparer& preparer_;
  std::optional<PosedGrid> still_;
  std::vector<Polynomial> polynomials_;
};

}  // namespace echopath
