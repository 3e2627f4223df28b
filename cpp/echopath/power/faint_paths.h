#pragma once
// Keeps of the diffuse paths that are too faint to matter one by one only some, which are drawn by lot.
//
// A hit on a rough surface makes a path over each pair of legs to the antennas. Where mirrors stand around there are dozens
// of pairs, and most of their paths lie far below the noise. Of these, one in 4, 16 or 64 is kept, and its power is
// multiplied by as much, so that the expected power of every cell stays what it is (Russian roulette: Arvo and Kirk 1990).
// What remains is at most as strong as the faint power: where a cell sums up many such paths, their sum fluctuates as that
// of all does. The paths over one diffuse hit share one number of the lot, because some of them arrive in phase: a path and
// its reversal, those over a pair of legs and over the pair exchanged, those over two mirrors in either order. Of one power,
// they are kept or left out together, with the square of their sum; only between paths of which fewer are kept and those of
// which more are kept, half of what they add in phase is lost.
#include "echopath/base/threads/job.h"
#include "echopath/record/paths.h"

namespace echopath {

// Returns the record without the faint paths that the lot leaves out, by `paths.frame.faint_power`; 0 keeps all paths.
// Whether a path is kept follows from the seed, from its diffuse hits and from its power and that of its reversal at the
// time of the trace, between the antennas among which each is the strongest. Paths that count for others have the flag
// kStandsForOthers. The statistics count those that are left out. Raises Cancelled.
Paths thinned(Paths paths, Job* job = nullptr);

}  // namespace echopath
