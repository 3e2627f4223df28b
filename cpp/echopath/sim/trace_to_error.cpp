#include "echopath/sim/trace_to_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "echopath/replay/received_power.h"

namespace echopath {
namespace {

double error_db(const ReceivedPower& power, const ReceivedPower& before) {
  if (before.power <= 0) return std::numeric_limits<double>::infinity();
  return std::hypot(power.error_db(), 10.0 * std::log10(power.power / before.power));
}

}  // namespace

void ErrorTarget::validate() const {
  require(error_db > 0, "target_error_db", "must be positive", error_db);
  require(max_rays >= 1, "max_rays", "must be >= 1", max_rays);
}

Paths trace_to_error(const Scene& scene, const Radar& radar, const TraceSettings& settings, const ErrorTarget& target,
                     Job* job, KeptGeometry* kept) {
  target.validate();
  settings.validate();
  require(settings.batches >= 2, "batches", "must be >= 2 for target_error_db", settings.batches);
  require(settings.num_rays <= target.max_rays, "num_rays", "must not exceed max_rays", settings.num_rays);
  KeptGeometry own;
  if (!kept) kept = &own;
  TraceSettings launch = settings;
  launch.num_rays = std::max<int64_t>(1, settings.num_rays / 2);
  ReceivedPower before = received_power(trace(scene, radar, launch, job, kept), job);
  launch.num_rays = settings.num_rays;
  for (;;) {
    Paths paths = trace(scene, radar, launch, job, kept);
    const ReceivedPower power = received_power(paths, job);
    paths.frame.target_error_db = target.error_db;
    paths.frame.error_db = error_db(power, before);
    const bool is_met = paths.frame.error_db <= target.error_db;
    if (is_met || launch.num_rays == target.max_rays || paths.frame.statistics.num_hits == 0) return paths;
    launch.num_rays = std::min(2 * launch.num_rays, target.max_rays);
    before = power;
  }
}

}  // namespace echopath
