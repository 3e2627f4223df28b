#pragma once
// Keeps of the diffuse paths that are too faint to matter one by one only some, which are drawn by lot.
//
// A hit on a rough surface makes a path over each pair of legs to the antennas. Where mirrors stand around there are dozens
// of pairs, and most of their paths lie far below the noise. Of these, one in 4, 16 or 64 is kept, and its power is
// multiplied by as much, so that the expected power of every cell stays what it is (Russian roulette: Arvo and Kirk 1990).
// What remains is at most as strong as the faint power: where a cell sums up many such paths, their sum fluctuates as that
// of all does. A path and its reversal, or those over a pair of legs and over the pair exchanged, arrive in phase: they are
// kept together.
#include "echopath/base/threads/job.h"
#include "echopath/record/paths.h"

namespace echopath {

// Returns the record without the faint paths that the lot leaves out, by `paths.frame.faint_power`; 0 keeps all paths.
// Whether a path is kept follows from the seed, from its hits and from its power and that of its reversal at the time of the
// trace, between the antennas among which each is the strongest. Paths that count for others have the flag kStandsForOthers.
// The statistics count those that are left out. Raises Cancelled.
Paths thinned(Paths paths, Job* job = nullptr);

}  // namespace echopath
