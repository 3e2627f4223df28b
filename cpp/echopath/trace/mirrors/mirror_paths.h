#pragma once
// Finds the paths over flagged mirrors alone, from transmitter to receiver, by the image method.
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/record/blocks/path_block.h"
#include "echopath/trace/frusta/antenna_frusta.h"
#include "echopath/trace/sbr/sbr.h"

namespace echopath {

// Returns one coherent path for each sequence of at most `settings.max_bounces` mirrors whose specular points exist and see
// each other; its weight is the product of Gamma s, its stratum kNoStratum. A path through an edge is the limit of those on
// both sides of it: the sequences of either side share its field in halves (the two orders of a corner; a seam between two
// mirrors; the rim of one). The search begins at both ends: frusta of the transmitter over the first half of the mirrors
// meet frusta of the receiver over the others. The blocks follow each other by number of mirrors and then by mirrors in
// travel order. Raises Cancelled when the job is cancelled.
std::vector<PathBlock> find_mirror_paths(const EmbreeScene& geometry, const std::vector<Mirror>& mirrors,
                                         const SbrSettings& settings, const AntennaFrusta& frusta, const Job* job);

}  // namespace echopath
