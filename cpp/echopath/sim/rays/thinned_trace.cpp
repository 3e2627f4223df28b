#include "echopath/sim/rays/thinned_trace.h"

#include "echopath/power/faint_paths.h"

namespace echopath {

Paths thinned_trace(const SceneSnapshot& scene, const Radar& radar, const TraceSettings& settings, Job* job,
                    KeptGeometry* kept, FittedStrata* fitted) {
  const RecordFilter filter = settings.faint_power > 0.0 ? RecordFilter(thinned) : RecordFilter();
  return trace(scene, radar, settings, job, kept, fitted, nullptr, filter);
}

}  // namespace echopath
