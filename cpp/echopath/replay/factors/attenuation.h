#pragma once
// Weakens echoes by the air along their whole lengths (TraceFrame::attenuation).
//
// All paths of one echo have one length, so that it acts on finished echoes; records of clear vacuum never come here.
#include "echopath/replay/evaluate/shared_legs.h"

namespace echopath {

// Multiplies the amplitudes at all nodes by exp(-attenuation * length). `num_paths` of the channels, from place 0 on, have
// been written; `attenuation` is in Np/m.
void attenuate(const ChannelSpan& channels, size_t num_paths, size_t num_nodes, double attenuation);

}  // namespace echopath
