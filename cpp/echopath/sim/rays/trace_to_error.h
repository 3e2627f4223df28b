#pragma once
// Traces with as many rays as a target error needs.
#include "echopath/sim/rays/ray_allocation.h"
#include "echopath/trace/embree/kept_geometry.h"
#include "echopath/trace/trace.h"

namespace echopath {

constexpr int64_t kFirstRays = int64_t{1} << 14;
constexpr int64_t kMaxRays = int64_t{1} << 24;
constexpr int64_t kMaxDefaultRays = 1000000;  // where neither rays nor a target are given
constexpr int kErrorBatches = 8;              // where standard errors are asked for

struct ErrorTarget {
  double error_db = 0.3;        // dB, half the 95 % interval of each echo, as far as rays mend it
  int64_t max_rays = kMaxRays;  // of one trace
  EchoFloor floor = EchoFloor::kStrongest;
  double least_power = 0.0;  // W, an echo that stays below it is known well enough, whatever the floor

  void validate() const;  // raises invalid_argument naming the field, the rule and the value
};

// Traces with settings.num_rays and then, as long as the echo of some stratum above the floor misses the target, with at
// least twice as many, shared out by what each stratum needs (ray_allocation.h), until max_rays; none gets fewer than
// before, as long as there are enough. The error is half the 95 % interval of the worst of them (power/received_power.h),
// of the footprint's bias and chance together, without what more rays hardly mend (PowerInterval::high_of_rays). Each
// trace is a fresh one: a finer lattice errs nearly like 1/rays, while more batches of the same lattice would win the
// square root only; all traces together cost less than twice the last. With the floor of the noise, one more trace at the
// end has the rays that cells of the map ask for, as many as there are at most. frame.target_error_db and frame.error_db
// tell the outcome. It stops at once where no ray meets anything. Raises as `trace`. All traces share one geometry:
// `kept`, as in `trace`, or their own. A standing_scene (still_rays.h) is traced to the target by itself first, with half
// of max_rays at most, and has the rays of that; `kept_still` keeps them for the frames to come.
Paths trace_to_error(const SceneSnapshot& scene, const Radar& radar, const TraceSettings& settings,
                     const ErrorTarget& target, Job* job, KeptGeometry* kept, KeptStillRays* kept_still = nullptr);

}  // namespace echopath
