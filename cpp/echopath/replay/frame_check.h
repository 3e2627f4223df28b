#pragma once
// Recorded paths checked at several times of a frame: the worst that becomes of each, and its power.
#include <complex>
#include <memory>
#include <vector>

#include "echopath/replay/amplitude.h"
#include "echopath/replay/frame_probe.h"
#include "echopath/replay/new_surface.h"

namespace echopath {

// Worst over the times of the check.
struct PathFinding {
  double power = 0.0;                // W, mean of |amplitude|^2 over the trace time and the times of the check
  std::complex<double> amplitude;    // sqrt(W), at the trace time
  double length = 0.0;               // m, at the trace time
  PathState state;
};

class FrameCheck {
 public:
  struct Scratch {
    ProbeScratch probe;
    EvaluationScratch evaluation;
    std::vector<LegMemo> known;  // by time, of the paths that were checked with this scratch
    explicit Scratch(int longest);  // hits of a path
  };

  // Amplitudes are those between the first antennas of `radar`. Paths and radar must outlive it. Where nothing moves, one time
  // stands for all. Raises invalid_argument when a motion does not cover a time, Cancelled.
  FrameCheck(const Paths& paths, const Radar& radar, std::vector<double> times,
             SpecularPoints specular = SpecularPoints::kMaterial, Job* job = nullptr);
  ~FrameCheck();

  LocalPaths localise(std::span<const int64_t> indices) const { return localise_(indices); }
  // Thread-safe.
  PathFinding check(const LocalPath& path, Scratch& scratch) const;
  // What is seen at the times of the check, by about `num_rays` rays in all.
  SurfaceSeen look(int64_t num_rays, Job* job = nullptr) const;
  // How far the length is off where specular hits stand as chosen.
  const LengthError& error_of(const PathState& state) const {
    return radio_.specular == SpecularPoints::kFermat ? state.stepped : state.frozen;
  }
  bool has_array() const { return probe_radar_.transmitters.size() + probe_radar_.receivers.size() > 2; }
  double wavenumber() const { return radio_.wavenumber; }

 private:
  struct View;
  bool is_still(const LocalPath& path) const;
  void evaluate(const LocalPath& path, Scratch& scratch, PathFinding& found) const;

  const Paths& paths_;
  Radar probe_radar_, first_radar_;
  Localiser localise_;
  SurfaceWalk walk_;
  RadioConstants radio_;
  std::vector<uint8_t> mesh_moves_;  // by mesh ID
  bool is_geometry_still_, is_still_;
  Vec3 origin_;
  std::unique_ptr<const View> trace_view_;
  std::vector<std::unique_ptr<const View>> views_;  // by time
};

}  // namespace echopath
