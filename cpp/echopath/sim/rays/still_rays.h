#pragma once
// Gives what stands still the same rays in all frames of a radar at rest.
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "echopath/record/paths.h"
#include "echopath/trace/launch/launch_focus.h"
#include "echopath/trace/trace.h"

namespace echopath {

// Where scatterers persist from frame to frame (Scatterers::kSurface), so must the rays of what stands still: other rays
// would find echoes that differ by their error, and who takes one frame from another would see what stands still beside what
// moves. Its rays are therefore shared out in the scene without all that moves or comes and goes, which is the same at all
// times, and what moves gets other rays beside them in each frame.
struct StillRays {
  LaunchGuide guide;  // of the strata of what stands still and the field of view; its shares count rays; empty: none

  StillRays() = default;
  explicit StillRays(LaunchGuide of_standing_scene);
  bool any() const { return !guide.shares.empty(); }
  bool holds(const std::string& stratum) const { return guide.shares.contains(stratum); }
  LaunchGuide taken_from(LaunchGuide whole) const;  // leaves the rays of what moves alone
};

// Returns the scene without what moves or has a lifetime; nothing where a trace has no steady rays (has_steady_rays), the
// settings have a guide, or all of the scene changes.
std::optional<Scene> standing_scene(const Scene& scene, const Radar& radar, const TraceSettings& settings);

// Keeps the StillRays of the first trace for the traces after it, which are those of the same scene, radar and settings but
// for the start. Thread-safe.
class KeptStillRays {
 public:
  // Returns what is kept or else what `find`, the trace of a pilot, says. Threads that ask meanwhile do not wait for it,
  // which nothing could cancel: they find the same.
  std::shared_ptr<const StillRays> get(const std::function<StillRays()>& find);

 private:
  std::shared_ptr<const StillRays> kept();

  std::mutex mutex_;
  std::shared_ptr<const StillRays> rays_;
};

// Returns what `kept` (may be null) keeps, or else what `find` says of the standing_scene; none where there is none.
std::shared_ptr<const StillRays> still_rays(const Scene& scene, const Radar& radar, const TraceSettings& settings,
                                            KeptStillRays* kept, const std::function<StillRays(const SceneSnapshot&)>& find);

}  // namespace echopath
