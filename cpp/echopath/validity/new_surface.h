#pragma once
// Surface that the antennas see at some time of a frame and that was hidden from the trace: its echoes are in no record.
#include <vector>

#include "echopath/base/job.h"
#include "echopath/trace/geometry/kept_geometry.h"
#include "echopath/trace/trace.h"

namespace echopath {

// How a record was traced, for traces of the same kind at other times.
TraceSettings settings_like(const TraceFrame& frame);

// Of one look at the scene as it is at one time.
struct Look {
  Paths paths;                   // what a trace finds then
  std::vector<uint8_t> is_new;   // [P] 1: a trace at the time of the record could not have had it
};

struct LookSettings {
  double time = 0.0;      // s
  int64_t num_rays = 0;
  uint64_t seed = 1;      // of directions and random phases
  size_t antenna = 0;     // of those of probe_radar(record, radar), in turn; 0: those of the trace, carried along
};

// A trace of the record's scene at another time, and what of it the record cannot have: a way that was blocked then, or led over
// points of reflection that their surface had not. It is the reverse of what `renew` takes out, so that a record without what is
// blocked and the new paths are a whole. `then`, `now`: geometry kept at the time of the record and from look to look. The same
// bits for any number of threads. Raises invalid_argument when a motion does not cover the time, Cancelled.
Look look_for_new_surface(const Paths& record, const Radar& radar, const LookSettings& settings, Job* job = nullptr,
                          KeptGeometry* then = nullptr, KeptGeometry* now = nullptr);

}  // namespace echopath
