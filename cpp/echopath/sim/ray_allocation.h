#pragma once
// Rays where the error is: what a trace of few rays says about how many each stratum needs.
#include <string>
#include <vector>

#include "echopath/base/job.h"
#include "echopath/sim/plan_foci.h"
#include "echopath/trace/geometry/kept_geometry.h"
#include "echopath/trace/trace.h"

namespace echopath {

// How many rays the echo of a stratum (of one object, or of one image of it) asks for.
struct RayNeed {
  std::string stratum;     // its name
  double rays = 0.0;
  KnownEcho echo;
  bool is_resolved = true;  // to the target, or below the floor
  double weight = 1.0;     // of images, below that of objects
};

// Which echoes matter.
enum class EchoFloor {
  kNoise,      // those that may stand above the noise of a cell of the range-Doppler map
  kStrongest,  // those down to 60 dB below the strongest
};

struct RayNeeds {
  std::vector<RayNeed> strata;  // in the order of the trace's, without foci
  double worst_db = 0.0;  // largest half interval of an echo above the floor

  double num_rays() const;
};

// Every stratum whose echo may stand above the floor asks for as many rays as bring its interval
// (power/received_power.h) to `target_db`, those of objects that move to a quarter of it: the interval of a coherent echo falls
// about with the rays, that of a diffuse one with their root, so that both ask in proportion to what they miss, within a factor
// of kMostGrowth. What is known better gives rays back, down to a sixteenth; what no ray has met keeps a quarter. Raises Cancelled.
RayNeeds ray_needs(const Paths& paths, double target_db, EchoFloor floor, Job* job = nullptr);
inline constexpr double kMostGrowth = 32.0;

// Shares of `num_rays` rays. Where they are too few, no stratum gets more for its weight than another that lacks rays: what needs
// few for its weight gets twice of that, as few rays tell their need within a factor of two, and the others share the rest by
// their weights. One that needs very many takes nothing away from those that fewer would serve.
RayShares share_out(const RayNeeds& needs, double num_rays);

// Shares of a trace of that many rays by what one of fewer rays says, with foci about its glints (plan_foci.h). Raises
// Cancelled.
LaunchGuide guide_rays(const Paths& paths, const RayNeeds& needs, int64_t num_rays, Job* job = nullptr);

// A trace whose rays are shared out by what each stratum above the noise needs for kResolvedDb (power/received_power.h): a
// pilot of an eighth of settings.num_rays tells, and is thrown away. Without a pilot, as `trace` shares them, where
// settings.guide says how, or where rays are few. Raises as `trace`.
Paths trace_by_need(const Scene& scene, const Radar& radar, const TraceSettings& settings, Job* job = nullptr,
                    KeptGeometry* kept = nullptr);

}  // namespace echopath
