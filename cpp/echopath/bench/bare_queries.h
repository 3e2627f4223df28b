#pragma once
// Compares the tracer's time with that of its own queries, asked again in a bare loop: how far it is from the limit of
// Embree.
#include <vector>

#include "echopath/trace/trace.h"

namespace echopath {

struct BareQueries {
  // Holds the seconds of each repetition: by the clock, and of all processors together, which other programs disturb less.
  struct Seconds {
    std::vector<double> elapsed, processor;
  };
  int64_t num_rays = 0, num_paths = 0;
  int64_t num_queries = 0;     // closest-hit and shadow queries of the rays
  int64_t num_in_packets = 0;  // of these queries
  int64_t num_shadow = 0;      // of these queries
  double build_seconds = 0.0;  // once for all rays: geometry, mirrors, launch plan
  // These are measured in turn: a trace with its record; its queries alone, packed as the tracer packs them; and the same
  // queries one by one.
  Seconds trace, bare, single;
};

// Traces, writes the queries down (on one thread) and measures, on as many threads as `set_num_threads` says. It needs 28
// bytes a query. Raises what `trace` raises; raises invalid_argument for repetitions below 1.
BareQueries measure_bare_queries(const Scene& scene, const Radar& radar, const TraceSettings& settings, int repetitions,
                                 Job* job);

}  // namespace echopath
