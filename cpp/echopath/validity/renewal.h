#pragma once
// Brings a record up to another time of the frame: it keeps what was hit and renews what has become of the legs between.
#include "echopath/base/threads/job.h"
#include "echopath/record/paths.h"
#include "echopath/trace/embree/kept_geometry.h"

namespace echopath {

struct Renewal {
  Paths paths;              // those that are still there, in their order; frame and radar are those of the trace
  int64_t num_blocked = 0;  // paths left out: something stands in the way of a leg, or an image has left its mirror
  int64_t num_lost = 0;     // paths left out: a point of reflection has left its surface
  int64_t num_moved = 0;    // paths whose points of reflection were found anew
};

// Returns the paths of a record as they are at `time` (s) for the trace's own antennas, carried along by the motion of
// `radar`. It renews the shadow rays of all legs and replaces frozen points of reflection by Fermat's, found by Newton
// steps over the surface. Material points keep their hits, and diffuse paths their weights and phases, so that rough
// surfaces keep their speckle and clutter stays where it is. Coherent paths without edges get the coefficients of their
// angles at the time (polarised ones through sheets keep theirs), and images over unmarked planes what edges then leave of
// their fields. Surface that came into view has no paths. What a curved bounce makes of the tube (Paths::curved_cell) stays
// as traced. The result has the same bits for any number of threads. Raises invalid_argument when a motion does not cover
// the time; raises DeviceError and Cancelled. `kept` is as in `trace`.
Renewal renew(const Paths& paths, const Radar& radar, double time, Job* job = nullptr, KeptGeometry* kept = nullptr);

// Returns [P] 1 where `renew` keeps the path at `time`, or where an image has left its unflagged plane, of which a trace
// then has paths of rays. For paths of another trace it tells those that one at `time` could have had, in one way or the
// other.
std::vector<uint8_t> still_there(const Paths& paths, const Radar& radar, double time, Job* job, KeptGeometry* kept);

}  // namespace echopath
