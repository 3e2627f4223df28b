#pragma once
// Puts rays where the error is: a trace of few rays tells how many each stratum needs.
#include <string>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/sim/rays/plan_foci.h"
#include "echopath/sim/rays/still_rays.h"
#include "echopath/trace/embree/kept_geometry.h"
#include "echopath/trace/trace.h"

namespace echopath {

// Tells how many rays the echo of a stratum (of one object, or of one image of it) needs.
struct RayNeed {
  std::string stratum;  // its name
  double rays = 0.0;
  double more_for_cells = 0.0;  // rays that the cells of the map ask for beyond these (hits_per_cell.h)
  KnownEcho echo;
  bool is_resolved = true;  // to the target, or below the floor
  double weight = 1.0;      // of images, below that of objects
  bool is_image = false;    // of an object over mirrors
  bool is_bounded = true;   // false: it asks for as many as kMaxGrowth allows, and may need any number more
};

// Tells which echoes matter.
enum class EchoFloor {
  kNoise,  // those that may stand above the noise of a cell of the range-Doppler map, whose cells count (hits_per_cell.h)
  kStrongest,  // those down to 60 dB below the strongest
};

// Says how many rays an error asks for.
enum class RayLaw {
  kByDecibels,  // few where much is missing, for a trace that others may follow with more
  kByPower,     // as many as the error relative to the power is too large, for the last trace
};

struct WantedError {
  double db = 0.3;  // half the 95 % interval of each echo, as far as rays mend it
  EchoFloor floor = EchoFloor::kStrongest;
  double least_power = 0.0;  // W, below which no echo matters, whatever the floor
  RayLaw law = RayLaw::kByDecibels;
  // Echoes that are known better give back all of their rays but this share; 1: none, so that what is known stays known.
  double least_growth = 1.0 / 16.0;
};

struct RayNeeds {
  std::vector<RayNeed> strata;  // in the order of the trace's, without foci
  double worst_db = 0.0;        // largest half interval of an echo above the floor

  double num_rays() const;            // without those for cells
  double num_rays_for_cells() const;  // beyond them
};

// Returns for every stratum, but those of `still`, whose echo may stand above the floor as many rays as bring its interval,
// as far as rays mend it (PowerInterval::high_of_rays), to what is wanted, for objects that move, but not for their images,
// to a quarter of it. The interval of a coherent echo falls about with the rays, that of a diffuse one with their root; both
// get rays in proportion to the error over the target, within a factor of kMaxGrowth. An echo that is known better gives
// rays back, down to WantedError::least_growth; a stratum that sends nothing back keeps a quarter, or that if it is more.
// One that was too small to have rays is counted as if it had the fewest that a stratum has. Cells ask for nothing where
// points stay on their surfaces (Scatterers::kSurface), since rays have no part in these. Raises Cancelled.
RayNeeds ray_needs(const Paths& paths, const WantedError& wanted, const StillRays& still = {}, Job* job = nullptr);
inline constexpr double kMaxGrowth = 32.0;

// Returns the shares of `num_rays` rays. Where they are too few, what the radar sees itself is served before images, up to
// kObjectsFirst of the rays. Among either, needs that are bounded are served in full, the smallest first, up to three
// quarters of their rays, so that as many as possible get what they need. The others share what is left by their weights,
// but no bounded need gets more than it asks while another lacks rays. Cells of the map get what they ask for beyond that,
// up to half of what the needs leave, or 15 % of the rays if that is more.
RayShares share_out(const RayNeeds& needs, double num_rays);

// Returns the guide for a trace of that many rays by the needs that one of fewer rays shows, with foci about its glints
// (plan_foci.h) and about narrow beams (beam_foci.h). What stands still gets the rays of `still`, and the needs are those of
// all else. Raises Cancelled.
LaunchGuide guide_rays(const Paths& paths, const RayNeeds& needs, int64_t num_rays, const StillRays& still = {},
                       Job* job = nullptr);

// Traces with rays shared out by what each stratum above the noise needs for kResolvedDb (power/received_power.h). A pilot
// trace of an eighth of settings.num_rays tells the needs, with a margin for what it does not foresee, and is thrown away.
// Where settings.guide gives the shares, or rays are few, there is no pilot, and rays are shared as in `trace`. Of a
// standing_scene (still_rays.h) a pilot tells how half of the rays go, and that of the frame how the rest does; `kept_still`
// keeps the first for the frames to come. Raises as `trace`.
Paths trace_by_need(const SceneSnapshot& scene, const Radar& radar, const TraceSettings& settings, Job* job,
                    KeptGeometry* kept, KeptStillRays* kept_still);

}  // namespace echopath
