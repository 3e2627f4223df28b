#pragma once
// Gives diffuse paths the lobes of their surfaces, where these are not Lambert's (em/surface/diffuse_lobe.h).
//
// The other parts of replay take every diffuse hit for one of Lambert's. A lobe depends on the directions of two legs at a
// time, so that no leg can hold it: it multiplies the amplitude by the square root of its quotient with Lambert's, with the
// directions of travel from the transmitter to the receiver, of each channel and time. Points of reflection on the way are
// those of the record.
#include "echopath/replay/evaluate/shared_legs.h"

namespace echopath {

// Multiplies the amplitudes of the plan's lobed paths, which have been written and are not joined with others.
void apply_lobes(const SharedLegPlan& plan, const PathPreparer& preparer, const PosedNodes& nodes,
                 const ChannelSpan& channels);

}  // namespace echopath
