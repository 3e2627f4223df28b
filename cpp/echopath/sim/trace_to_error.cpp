#include "echopath/sim/trace_to_error.h"

#include <algorithm>

#include "echopath/replay/received_power.h"

namespace echopath {

void ErrorTarget::validate() const {
  require(error_db > 0, "target_error_db", "must be positive", error_db);
  require(max_rays >= 1, "max_rays", "must be >= 1", max_rays);
}

Paths trace_to_error(const Scene& scene, const Radar& radar, const TraceSettings& settings, const ErrorTarget& target, Job* job) {
  target.validate();
  settings.validate();
  require(settings.batches >= 2, "batches", "must be >= 2 for target_error_db", settings.batches);
  require(settings.num_rays <= target.max_rays, "num_rays", "must not exceed max_rays", settings.num_rays);
  TraceSettings launch = settings;
  Paths paths;
  for (;;) {
    paths = Paths();  // frees the last record before the next is made
    paths = trace(scene, radar, launch, job);
    paths.frame.target_error_db = target.error_db;
    paths.frame.error_db = received_power(paths, job).error_db();
    const bool is_met = paths.frame.error_db <= target.error_db;
    if (is_met || launch.num_rays == target.max_rays || paths.frame.statistics.num_hits == 0) return paths;
    launch.num_rays = std::min(2 * launch.num_rays, target.max_rays);
  }
}

}  // namespace echopath
