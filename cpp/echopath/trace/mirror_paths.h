#pragma once
// Paths over flagged mirrors alone, from transmitter to receiver, by the image method.
#include "echopath/trace/path_block.h"
#include "echopath/trace/sbr.h"

namespace echopath {

// Appends one coherent path for each sequence of at most `settings.max_bounces` mirrors whose specular points exist and see
// each other; weight = product of Gamma s. Where the path runs through the common edge of the planes of a corner, all orders
// of these bounces are found and share the field: each has weight 1 / (number of orders). Stratum 255.
void add_mirror_paths(const EmbreeScene& geometry, const Scene& scene, const std::vector<Mirror>& mirrors,
                      const SbrSettings& settings, PathBlock& block);

}  // namespace echopath
