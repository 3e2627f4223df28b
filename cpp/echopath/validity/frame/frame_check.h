#pragma once
// Checks recorded paths at several times of a frame: finds the worst that becomes of each, and its power.
#include <complex>
#include <memory>
#include <vector>

#include "echopath/replay/evaluate/path_evaluator.h"
#include "echopath/trace/embree/kept_geometry.h"
#include "echopath/validity/frame/check_times.h"
#include "echopath/validity/frame/frame_probe.h"

namespace echopath {

// Holds the echo of a path between the first antennas, at one time.
struct Echo {
  std::complex<double> amplitude;         // sqrt(W)
  double length = 0.0;                    // m
  bool is_lost = false;                   // something blocks a leg, or a point of reflection has left its surface
  std::complex<double> edge_ratio = 1.0;  // PathState::edge_ratio
};

// Holds what was found of one path over the times that were checked.
struct PathFinding {
  double power = 0.0;  // W, sum of |amplitude|^2 over the trace time and those times
  int num_powers = 0;  // terms in that sum
  PathState state;     // worst
  double mean_power() const { return num_powers > 0 ? power / num_powers : 0.0; }
};

class FrameCheck {
 public:
  struct Scratch {
    ProbeScratch probe;
    std::vector<LegMemo> known;     // by time, of the paths that were checked with this scratch
    explicit Scratch(int longest);  // most hits of a path
  };

  // Amplitudes are those between the first antennas of `radar`. Paths and radar must outlive it. Raises invalid_argument
  // when a motion does not cover a time; raises Cancelled.
  FrameCheck(const Paths& paths, const Radar& radar, CheckTimes times, SpecularPoints specular = SpecularPoints::kMaterial,
             Job* job = nullptr);
  ~FrameCheck();

  const CheckTimes& times() const { return times_; }
  LocalPaths prepare(std::span<const int64_t> indices) const { return preparer_(indices); }
  // Returns how many of the times a path needs, counted from the first, by what it touches and what may come in its way.
  int times_of(const LocalPath& path) const;

  // Returns how many times are best posed together. Each has geometry of its own then, which a scene of many triangles, even
  // if few of them move, is quicker without, and which takes its memory.
  size_t times_at_once() const;
  // Poses the scene at so many times from the one of index `first` on, for `check`. No other call may run meanwhile.
  void pose(size_t first, Job* job = nullptr);
  // Ends the check: nothing is posed any more. Hands over the geometries for other uses, of which there is at least one.
  std::vector<std::unique_ptr<EmbreeScene>> take_geometries();
  // Returns the echoes [P] at the trace time. Thread-safe, as all that follows.
  std::vector<Echo> at_trace(std::span<const int64_t> paths) const;
  // Returns the echoes [P, time] at the posed times. `local` holds the same paths; `traced` holds their echoes at the trace
  // time, which paths on which nothing moves keep.
  std::vector<Echo> at_posed_times(std::span<const int64_t> paths, const LocalPaths& local,
                                   std::span<const Echo> traced) const;
  size_t num_posed_times() const { return views_.size(); }
  // Adds what becomes of a path at the posed times that it needs. `traced` is its echo at the trace time, and `posed` those
  // at the posed times, whose `is_lost` is set here. Returns how many times it needed.
  size_t check(const LocalPath& path, int num_times, const Echo& traced, std::span<Echo> posed, Scratch& scratch,
               PathFinding& found) const;

  // Returns how far the length is off where specular hits stand as chosen.
  const LengthError& error_of(const PathState& state) const {
    return specular_ == SpecularPoints::kFermat ? state.stepped : state.frozen;
  }
  const Radar& first_radar() const { return first_radar_; }
  size_t num_antenna_pairs() const { return std::max(probe_radar_.transmitters.size(), probe_radar_.receivers.size()); }
  bool has_array() const { return probe_radar_.transmitters.size() + probe_radar_.receivers.size() > 2; }
  bool anything_moves() const { return !is_still_; }
  double wavenumber() const { return radio_.wavenumber; }

 private:
  struct View;
  struct Sweep;
  bool is_still(const LocalPath& path) const;
  std::vector<Echo> echoes_at(std::span<const int64_t> paths, const PosedNodes& nodes) const;
  void find_sweeps();
  // Returns the geometry at one of the posed times, updated from the time that stood in its place.
  const EmbreeScene& posed_geometry(size_t index, const PosedScene& pose, Job* job);

  const Paths& paths_;
  CheckTimes times_;
  Radar probe_radar_, first_radar_;
  PathPreparer preparer_;
  SurfaceWalk walk_;
  RadioConstants radio_;
  SheetPassages sheets_;
  SpecularPoints specular_;
  bool sheets_move_ = false;         // that paths go through
  std::vector<uint8_t> mesh_moves_;  // by mesh ID
  bool is_geometry_still_, is_still_;
  Vec3 origin_;
  std::vector<std::unique_ptr<EmbreeScene>> geometries_;  // [posed times], the first of them first posed as traced
  std::unique_ptr<const View> trace_view_;                // for cosines, which ask no geometry
  std::vector<std::unique_ptr<const View>> views_;        // posed
  // Poses the first antennas and all meshes; they are kept for the time of the trace and for the posed times.
  PosedNodes posed_nodes(std::span<const double> times) const;
  PosedNodes traced_nodes_, posed_nodes_;
  size_t first_posed_ = 0;
  std::vector<Sweep> sweeps_;  // of the meshes that need more times than others
};

}  // namespace echopath
