#pragma once
// Finds points of reflection behind bounces off curved surfaces.
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/sim/rays/find_glints.h"

namespace echopath {

// Returns the directions of launch about which coherent paths over several surfaces are stationary, as far as the launch
// cells of the record point at them: with the phase g.x + x.h.x / 2 across the cell of a path, at x = -g/h, if that lies no
// further than a cell away. What one cell points at alone is left out, because it lies beyond the reach of a second order:
// the surface has turned on the way, or ends. Several paths point at one glint, some a little beside it (Glint::blur).
// Raises Cancelled.
std::vector<Glint> find_chain_glints(const Paths& paths, Job* job);

}  // namespace echopath
