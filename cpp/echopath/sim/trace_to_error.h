#pragma once
// A trace with as many rays as an error asks for.
#include "echopath/trace/kept_geometry.h"
#include "echopath/trace/trace.h"

namespace echopath {

constexpr int64_t kDefaultRays = 1000000;         // without a target
constexpr int64_t kFirstRays = int64_t{1} << 14;  // with a target
constexpr int64_t kMaxRays = int64_t{1} << 24;
constexpr int kTargetBatches = 8;

struct ErrorTarget {
  double error_db = 0.1;        // dB, of the received power
  int64_t max_rays = kMaxRays;  // of one trace

  void validate() const;  // raises invalid_argument naming the field, the rule and the value
};

// Traces with settings.num_rays and then, as long as the error is larger, with twice as many, until max_rays. The error
// is the root of the sum of squares of the standard error (replay/received_power.h) and of the change, in dB, from the
// trace before: what halving the rays changes is about what is left of errors that all batches share, such as sidelobes
// that the footprint filter takes away. The first is compared with a trace of half as many rays. Each trace is a fresh
// one: a finer lattice errs nearly like 1/rays, while more batches of the same lattice would win the square root only;
// all traces together cost less than twice the last. frame.target_error_db and frame.error_db tell the outcome. Stops
// at once where no ray meets anything. The standard error of few batches is itself uncertain, by 1/sqrt(2 (batches -
// 1)). Raises as trace, and for less than 2 batches. All traces share one geometry: `kept`, as in `trace`, or their own.
Paths trace_to_error(const Scene& scene, const Radar& radar, const TraceSettings& settings, const ErrorTarget& target,
                     Job* job = nullptr, KeptGeometry* kept = nullptr);

}  // namespace echopath
