#pragma once
// Paths over flagged mirrors alone, from transmitter to receiver, by the image method.
#include "echopath/trace/path_block.h"
#include "echopath/trace/sbr.h"

namespace echopath {

// Appends one coherent path for each sequence of at most `settings.max_bounces` mirrors whose specular points exist and see
// each other; weight = product of Gamma s. A path through an edge is the limit of those on both sides of it: the sequences
// of either side share its field in halves (the two orders of a corner; a seam between two mirrors; the rim of one).
// Stratum kNoStratum.
void add_mirror_paths(const EmbreeScene& geometry, const std::vector<Mirror>& mirrors, const SbrSettings& settings,
                      PathBlock& block);

}  // namespace echopath
