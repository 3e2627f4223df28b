#pragma once
// A trace with as many rays as an error asks for.
#include "echopath/trace/trace.h"

namespace echopath {

constexpr int64_t kDefaultRays = 1000000;        // without a target
constexpr int64_t kFirstRays = int64_t{1} << 14;  // with a target
constexpr int64_t kMaxRays = int64_t{1} << 24;
constexpr int kTargetBatches = 8;

struct ErrorTarget {
  double error_db = 0.1;         // dB, standard error of the received power (replay/received_power.h)
  int64_t max_rays = kMaxRays;   // of one trace

  void validate() const;  // raises invalid_argument naming the field, the rule and the value
};

// Traces with settings.num_rays and then, as long as the error is larger, with twice as many, until max_rays. Each trace is a
// fresh one: a finer lattice errs nearly like 1/rays, while adding batches to those there are would win their square root only;
// all traces together cost less than twice the last. frame.target_error_db and frame.error_db tell the outcome. Stops at once
// where no ray meets anything. An error from few batches is itself uncertain, by 1/sqrt(2 (batches - 1)). Raises as trace and
// for less than 2 batches.
Paths trace_to_error(const Scene& scene, const Radar& radar, const TraceSettings& settings, const ErrorTarget& target,
                     Job* job = nullptr);

}  // namespace echopath
