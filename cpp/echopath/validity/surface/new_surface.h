#pragma once
// Finds surface that the antennas see at some time of a frame and that was hidden from the trace, so that no record has its
// echoes.
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/trace/embree/kept_geometry.h"
#include "echopath/trace/mirrors/plane_doubles.h"
#include "echopath/trace/trace.h"

namespace echopath {

// Returns the settings of a record's trace, for traces of the same kind at other times.
TraceSettings settings_like(const TraceFrame& frame);

// Holds what a trace of the scene as it is at one time finds.
struct SurfaceSearch {
  Paths paths;                  // all paths of this trace, [P]
  std::vector<uint8_t> is_new;  // [P] 1: a trace at the time of the record could not have found the path
  PlaneDoubles doubles;         // what the images among all of them stand for
};

struct SurfaceSearchSettings {
  double time = 0.0;  // s
  int64_t num_rays = 0;
  uint64_t seed = 1;   // of directions and random phases
  size_t antenna = 0;  // index into the antennas of probe_radar(record, radar); 0: the trace's, carried along
};

// Traces the record's scene at another time and marks the paths that the record cannot have: then something blocked a leg,
// or a point of reflection did not lie on its surface, and no rays met the surface instead. It is the reverse of what
// `renew` takes out, so that a record without its blocked paths, together with the new paths, is a whole. `then` and `now`
// keep geometry at the time of the record and from look to look. The result has the same bits for any number of threads.
// Raises invalid_argument when a motion does not cover the time; raises Cancelled.
SurfaceSearch trace_new_surface(const Paths& record, const Radar& radar, const SurfaceSearchSettings& settings, Job* job,
                                KeptGeometry* then, KeptGeometry* now);

}  // namespace echopath
