#pragma once
// Traces a scene: rays that see scene and radar at mid-frame make the paths of the record.
#include <functional>

#include "echopath/base/threads/job.h"
#include "echopath/record/paths.h"
#include "echopath/scene/scene_snapshot.h"
#include "echopath/trace/launch/launch_focus.h"

namespace echopath {

class KeptGeometry;  // trace/embree/kept_geometry.h
class FittedStrata;  // trace/strata/fitted_strata.h
class PlaneDoubles;  // trace/mirrors/plane_doubles.h

inline constexpr int64_t kMostRays = 10000000000;

struct TraceSettings : RecordSettings {
  int64_t num_rays = 1000000;    // 1 to kMostRays, and so few that the machine has memory for their record
  int64_t num_rays_to_come = 0;  // of a trace of the same scene that this one prepares; the memory must do for it too
  double start_time = 0.0;       // s, first sample of the frame
  LaunchGuide guide = {};        // by default the rule of launch.h
  // The scene is edited from trace to trace: rays are planned object by object (LaunchSettings::by_object) and the geometry
  // is rounded (EmbreeScene::Upkeep::kEdits), so that an edit leaves most rays as they are. Others are shot than without.
  bool for_edits = false;

  void validate() const;  // raises invalid_argument naming the field, the rule and the value

  bool operator==(const TraceSettings&) const = delete;  // that of the record's alone would stand for it
};

// Takes a part of the record and returns what of it is kept, in the same order.
using RecordFilter = std::function<Paths(Paths part, Job* job)>;

// Returns whether what stands still gets the same rays in all frames (LaunchSettings::is_steady): where scatterers persist,
// before a radar at rest, in a scene that ever changes.
bool has_steady_rays(const Scene& scene, const Radar& radar, Scatterers scatterers);

// Shoots the rays from the mean transmitter position at mid-frame and connects hits to the mean receiver position.
// Deterministic: the same input gives the same bits for any number of threads. Raises invalid_argument for bad settings,
// a radar without antennas, a smooth mirror that is not flat, or a motion that does not cover the frame; raises
// DeviceError; raises Cancelled. With `kept`, the trace uses the geometry of the trace before where it can, and leaves
// its own for the next: the record is the same and comes sooner, but the memory stays in use. `fitted` does the same for
// the strata of surfaces that the trace before saw from the same place. `doubles` becomes what was left out of the rays'
// paths, because images over unflagged planes stand for it. A `filter` goes over the record part by part while that is made,
// so that what it leaves out takes no memory.
Paths trace(const SceneSnapshot& scene, const Radar& radar, const TraceSettings& settings, Job* job = nullptr,
            KeptGeometry* kept = nullptr, FittedStrata* fitted = nullptr, PlaneDoubles* doubles = nullptr,
            const RecordFilter& filter = {});

}  // namespace echopath
