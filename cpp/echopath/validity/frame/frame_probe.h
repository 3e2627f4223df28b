#pragma once
// Finds what has become of recorded paths at one instant of a frame: how far their frozen points of reflection are off,
// which legs something blocks, how the surfaces have turned, and what edges of planes leave of images over them.
#include <algorithm>
#include <complex>

#include "echopath/replay/posed/local_paths.h"
#include "echopath/replay/posed/specular_slide.h"
#include "echopath/validity/legs/leg_memo.h"
#include "echopath/validity/surface/surface_walk.h"

namespace echopath {

// Tells how far a length is off, m. The true length is that over the points of the mesh one Newton step farther, less what e
// (specular_slide.h) estimates of the rest.
struct LengthError {
  double motion = 0.0;   // for the trace's own antennas, carried along by the radar's motion
  double largest = 0.0;  // over them and the rim of the array
};

// Describes a path at one instant. Hits are counted in the order of the record, TX -> RX.
struct PathState {
  LengthError frozen;    // over the hits where they were recorded (SpecularPoints::kMaterial)
  LengthError stepped;   // one Newton step from there (SpecularPoints::kFermat)
  uint64_t left = 0;     // bit per hit: its point of reflection leaves the surface or is lost, for some antenna
  uint64_t blocked = 0;  // bit per hit: something blocks the leg that arrives there, for some antenna
  bool is_receiver_blocked = false;
  bool is_turned = false;      // some cosine changes by more than a factor of two, or its sign, or an image's coefficient
  double cosine_change = 0.0;  // largest change of a cosine of incidence or departure
  // Of an image over unmarked planes these are the field that edges leave for the trace's antennas, over that of the record;
  // the largest change of it for some antenna, over the larger of both; and EdgeShare::slide at most.
  std::complex<double> edge_ratio = 1.0;
  double edge_change = 0.0, edge_slide = 0.0;
};

// Returns `radar` with the trace's antennas, carried along by its motion, first, and then those at the rim of its array.
Radar probe_radar(const Paths& paths, const Radar& radar);

struct ProbeScratch {
  std::vector<PosedHit> hits, stepped, found;  // at least as many as the path's hits
  std::vector<double> reference;               // [2 * hits] cosines at the trace time
  std::vector<double> cosines;
  SpecularSlide slide, check;

  explicit ProbeScratch(int longest) : hits(static_cast<size_t>(longest) + 1), stepped(hits.size()), found(hits.size()) {}
};

class FrameProbe {
 public:
  // preparer: of whole meshes (touched_meshes.h). pose, rim: at the time; rim with the antennas of probe_radar, relative to
  // the origin of `geometry`. All must outlive the probe. wavenumber: rad/m.
  FrameProbe(const PathPreparer& preparer, const PosedScene& pose, const PosedScene& rim, const EmbreeScene& geometry,
             const SurfaceWalk& walk, double wavenumber)
      : preparer_(preparer), pose_(pose), rim_(rim), geometry_(geometry), walk_(walk), wavenumber_(wavenumber) {}

  // Writes the signed cosines of incidence and departure [2 * hits] for the trace's antennas. At images they are 0, but
  // those of incidence where all hits are images.
  void cosines(const LocalPath& path, ProbeScratch& scratch, std::vector<double>& out) const;
  // Checks a path. scratch.reference holds the cosines at the trace time; `known` is used with this probe alone.
  // Thread-safe.
  PathState check(const LocalPath& path, ProbeScratch& scratch, LegMemo& known) const;

 private:
  struct Slides;
  void check_slides(const LocalPath& path, ProbeScratch& scratch, PathState& state) const;
  uint64_t find_stepped(const LocalPath& path, ProbeScratch& scratch, uint64_t& left) const;
  Slides slides_from(const LocalPath& path, const Vec3& start, ProbeScratch& scratch) const;
  bool move_hit(const LocalHit& hit, const Vec3& point, PosedHit& out, bool& is_near) const;
  LegShadows shadows_of_images(const LocalPath& path, const PosedHit* hits) const;
  LegShadows shadows_of(const LocalPath& path, const PosedHit* hits, LegMemo& known) const;
  void check_cosines(const LocalPath& path, ProbeScratch& scratch, PathState& state) const;
  void check_coefficients(const LocalPath& path, ProbeScratch& scratch, PathState& state) const;
  void check_edges(const LocalPath& path, const PosedHit* hits, PathState& state) const;
  // Calls `visit` with the ends of a path at each of its antennas: both go from rim to rim by turns.
  template <class Visit>
  void for_antennas_in_turn(const LocalPath& path, Visit visit) const {
    const size_t num_pairs = std::max(starts(path).size(), ends(path).size());
    for (size_t i = 0; i < num_pairs; ++i)
      visit(starts(path)[std::min(i, starts(path).size() - 1)], ends(path)[std::min(i, ends(path).size() - 1)]);
  }
  const std::vector<PosedAntenna>& starts(const LocalPath& path) const {
    return path.is_reversed ? rim_.receivers : rim_.transmitters;
  }
  const std::vector<PosedAntenna>& ends(const LocalPath& path) const {
    return path.is_reversed ? rim_.transmitters : rim_.receivers;
  }

  const PathPreparer& preparer_;
  const PosedScene& pose_;
  const PosedScene& rim_;
  const EmbreeScene& geometry_;
  const SurfaceWalk& walk_;
  double wavenumber_;
};

}  // namespace echopath
