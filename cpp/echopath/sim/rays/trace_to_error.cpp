#include "echopath/sim/rays/trace_to_error.h"

#include <algorithm>
#include <cmath>

#include "echopath/power/faint_paths.h"
#include "echopath/trace/strata/fitted_strata.h"

namespace echopath {
namespace {

constexpr double kFewForCells = 0.1;  // of the rays: cells that ask for less get none

double error_of(const Paths& paths, const WantedError& wanted, Job* job) {
  return ray_needs(paths, wanted, {}, job).worst_db;
}

// Returns the record with the error that it has once faint paths are left out by lot, which more rays hardly mend.
Paths with_error_of_lot(Paths paths, const WantedError& wanted, Job* job) {
  if (paths.frame.statistics.num_faint_paths > 0) {
    paths.frame.error_db = std::max(paths.frame.error_db, error_of(paths, wanted, job));
  }
  return paths;
}

// Returns how many rays the next trace has. Where what moves may need as many as there are beside those of `still`, it gets
// these at once: a trace of what moves alone would hardly save rays.
int64_t rays_to_come(const StillRays& still, const RayNeeds& needs, int64_t before, int64_t most) {
  const double margin = still.any() ? 2.0 : 1.0, all = still.guide.num_rays() + needs.num_rays(),
               limit = static_cast<double>(most);
  if (still.guide.num_rays() + margin * needs.num_rays() >= limit) return most;
  return std::clamp<int64_t>(std::llround(all), std::min(2 * before, most), most);
}

// Traces what moves with ever more rays, and at the end beside what stands still, which has the rays of `still`. Without
// any, all count as what moves.
Paths trace_to_error_beside(const StillRays& still, const SceneSnapshot& scene, const Radar& radar,
                            const TraceSettings& settings, const ErrorTarget& target, Job* job, KeptGeometry* kept) {
  KeptGeometry own;
  if (!kept) kept = &own;
  FittedStrata fitted;
  TraceSettings launch = settings;
  LaunchGuide guide;
  bool is_whole = !still.any(), has_served_cells = false;
  const WantedError wanted{
      .db = target.error_db, .floor = target.floor, .least_power = target.least_power, .least_growth = 1.0};
  for (;;) {
    Paths paths = trace(scene, radar, launch, job, kept, &fitted);
    const RayNeeds needs = ray_needs(paths, wanted, still, job);
    paths.frame.target_error_db = target.error_db;
    const bool is_met = needs.worst_db <= target.error_db, has_most = launch.num_rays == target.max_rays,
               is_first = launch.guide.shares.empty();
    // Cells are served once, with as many rays as there are before, at most: they ask by few hits.
    const auto before = static_cast<double>(launch.num_rays);
    const double for_cells = std::min(needs.num_rays_for_cells(), before);
    const bool serves_cells = is_met && !has_most && !has_served_cells && for_cells > kFewForCells * before;
    const bool is_done = is_whole && (still.any() || is_met || has_most);
    if ((is_done && !serves_cells) || (is_first && paths.frame.statistics.num_hits == 0)) {
      // Alone, what stands still may be known worse: there fainter echoes stand above the floor.
      paths.frame.error_db = still.any() ? error_of(paths, wanted, job) : needs.worst_db;
      return with_error_of_lot(thinned(std::move(paths), job), wanted, job);
    }
    has_served_cells = has_served_cells || serves_cells;
    if (is_first || !is_met || serves_cells) {
      launch.num_rays = serves_cells ? std::min<int64_t>(launch.num_rays + std::llround(for_cells), target.max_rays)
                                     : rays_to_come(still, needs, launch.num_rays, target.max_rays);
      guide = guide_rays(paths, needs, launch.num_rays, still, job);
    }
    is_whole = !still.any() || is_met || launch.num_rays == target.max_rays;
    launch.guide = is_whole ? guide : still.taken_from(guide);
  }
}

}  // namespace

void ErrorTarget::validate() const {
  require(error_db > 0, "target_error_db", "must be positive", error_db);
  require(least_power >= 0, "least_power", "must be at least 0 W", least_power);
  require(max_rays >= 1 && max_rays <= kMostRays, "max_rays", "must lie in [1, 10000000000]", max_rays);
}

Paths trace_to_error(const SceneSnapshot& scene, const Radar& radar, const TraceSettings& settings,
                     const ErrorTarget& target, Job* job, KeptGeometry* kept, KeptStillRays* kept_still) {
  target.validate();
  settings.validate();
  require(settings.num_rays <= target.max_rays, "num_rays", "must not exceed max_rays", settings.num_rays);
  const auto still = still_rays(*scene, radar, settings, kept_still, [&](const SceneSnapshot& standing) {
    ErrorTarget of_half = target;
    TraceSettings few = settings;
    of_half.max_rays = std::max<int64_t>(target.max_rays / 2, 1);
    few.num_rays = std::min(settings.num_rays, of_half.max_rays);
    const Paths paths = trace_to_error_beside({}, standing, radar, few, of_half, job, nullptr);
    return StillRays(guide_like(paths.frame.strata));
  });
  return trace_to_error_beside(*still, scene, radar, settings, target, job, kept);
}

}  // namespace echopath
