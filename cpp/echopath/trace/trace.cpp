#include "echopath/trace/trace.h"

#include <cmath>

#include "echopath/base/range_of_coordinates.h"
#include "echopath/trace/tracer.h"

namespace echopath {

void TraceSettings::validate() const {
  require(num_rays >= 1 && num_rays <= kMostRays, "num_rays", "must lie in [1, 10000000000]", num_rays);
  require(max_bounces >= 1 && max_bounces <= 64, "max_bounces", "must lie in [1, 64]", max_bounces);
  require_time(start_time, "start_time");
  require(batches >= 1 && batches <= 64, "batches", "must lie in [1, 64]", batches);
  require(std::isfinite(attenuation) && attenuation >= 0, "attenuation", "must be >= 0 Np/m", attenuation);
  require(std::isfinite(faint_power) && faint_power >= 0, "faint_power", "must be >= 0 W", faint_power);
  guide.validate();
}

bool has_steady_rays(const Scene& scene, const Radar& radar, Scatterers scatterers) {
  return scatterers == Scatterers::kSurface && !radar.is_moving() && scene.ever_changes();
}

Paths trace(const SceneSnapshot& scene, const Radar& radar, const TraceSettings& settings, Job* job, KeptGeometry* kept,
            FittedStrata* fitted, PlaneDoubles* doubles, const RecordFilter& filter) {
  return Tracer(scene, radar, settings, job, kept, fitted).run(job, doubles, filter);
}

}  // namespace echopath
