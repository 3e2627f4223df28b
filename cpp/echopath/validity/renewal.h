#pragma once
// A record brought up to another time of the frame: what was hit is kept, what has become of the ways between is renewed.
#include "echopath/base/job.h"
#include "echopath/trace/geometry/kept_geometry.h"
#include "echopath/trace/record/paths.h"

namespace echopath {

struct Renewal {
  Paths paths;               // those that are still there, in their order; frame and radar are those of the trace
  int64_t num_blocked = 0;   // paths left out: something stands in the way of a leg, or an image has left its mirror
  int64_t num_lost = 0;      // paths left out: a point of reflection has left its surface
  int64_t num_moved = 0;     // paths whose points of reflection were found anew
};

// The paths of a record as they are at `time` (s) for the trace's own antennas, carried along by the motion of `radar`: shadow
// rays of all legs are renewed, and frozen points of reflection are replaced by Fermat's, found by Newton steps over the surface.
// Material points keep their hits, weights and phases, so that rough surfaces keep their speckle and clutter stays where it is.
// Surface that came into view has no paths. What a curved bounce makes of the tube (Paths::curved_cell) stays as traced. The same
// bits for any number of threads. Raises invalid_argument when a motion does not cover the time, DeviceError, Cancelled. `kept`: as in `trace`.
Renewal renew(const Paths& paths, const Radar& radar, double time, Job* job = nullptr, KeptGeometry* kept = nullptr);

// [P] 1: the path is still there at `time`, as `renew` has it. Of paths of another trace: those that one at `time` could have had.
std::vector<uint8_t> still_there(const Paths& paths, const Radar& radar, double time, Job* job = nullptr,
                                 KeptGeometry* kept = nullptr);

}  // namespace echopath
