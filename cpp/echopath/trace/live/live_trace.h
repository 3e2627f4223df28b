#pragma once
// Keeps the record of a scene that is changed again and again: after a change it shoots only those rays again that the
// change may touch.
//
// A ray's paths depend on its plan, on the answers of its queries and on the surfaces that it meets. All queries of some
// rays in a row are remembered as stretches of space (queried_space.h). A changed mesh was in one box before and is in
// another one now; rays of which no stretch meets either box have the same paths as before. Rays are planned object by
// object (TraceSettings::for_edits), so that an object that comes, goes or begins to move leaves most others their rays;
// meshes and strata of two records are the same by their names. Where a change reaches what all rays share (antennas,
// flagged mirrors, the settings, a scene that grows beyond a power of two of metres), all are shot again.
#include <functional>
#include <memory>
#include <utility>

#include "echopath/trace/embree/kept_geometry.h"
#include "echopath/trace/strata/fitted_strata.h"
#include "echopath/trace/trace.h"

namespace echopath {

class LiveRecord;  // live_record.h

class LiveTrace {
 public:
  // Tells how the record differs from the one before.
  struct Change {
    bool is_whole = false;  // little or nothing is as before: `removed` is empty and `added` is all
    // These are the paths that are gone, in the scene before, and the paths that are new, in the scene now. The signal of
    // the record is that of the record before without the former and with the latter. Unless is_whole, their scenes have
    // only the meshes that they meet, with mesh IDs of their own, or all (Scenes).
    Paths removed, added;
    int64_t num_rays = 0;       // of the record, about as many as are asked for (rays_by_object)
    int64_t num_rays_shot = 0;  // of them, the others being kept
  };

  // Holds a record that may take the place of the present one.
  struct Next {
    Change change;
    std::shared_ptr<const LiveRecord> record;
  };

  // Says which meshes the scenes of changes have. Those of what is met cost less to pose; selections may name any of all.
  enum class Scenes { kOfWhatIsMet, kWhole };

  // `finish` makes of all paths of some rays those of the record (power/faint_paths.h, say), alike whatever other rays'
  // paths are beside them; null: they are the record's as they are.
  explicit LiveTrace(Scenes scenes = Scenes::kOfWhatIsMet, std::function<Paths(Paths, Job*)> finish = nullptr);
  // Makes the record of the scene, radar and settings given, which `accept` puts in the place of the present one. Raises as
  // `trace`.
  Next prepare(const SceneSnapshot& scene, const Radar& radar, const TraceSettings& settings, Job* job = nullptr);
  // Returns how the record differs from the one before. `next` must have been prepared since that came.
  Change accept(Next&& next);
  // Prepares and accepts a change. Where it raises, the record is the one before.
  Change update(const SceneSnapshot& scene, const Radar& radar, const TraceSettings& settings, Job* job = nullptr) {
    return accept(prepare(scene, radar, settings, job));
  }
  // Returns the record as `trace` gives it for the last update with settings for edits, but for the numbers of queries in
  // its statistics. Raises invalid_argument before the first update; raises Cancelled.
  Paths paths(Job* job = nullptr) const;

 private:
  Paths finished(Paths paths, Job* job) const { return finish_ ? finish_(std::move(paths), job) : paths; }

  Scenes scenes_;
  std::function<Paths(Paths, Job*)> finish_;
  KeptGeometry kept_;
  FittedStrata fitted_;
  std::shared_ptr<const LiveRecord> record_;
};

}  // namespace echopath
