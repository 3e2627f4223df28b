#pragma once
// Finds the echoes of sharp edges behind and before mirrors that nobody flagged: in corners, ducts and boxes.
#include <vector>

#include "echopath/trace/edges/edge_paths.h"
#include "echopath/trace/edges/plane_legs.h"

namespace echopath {

// Returns one path for each piece of an edge whose face waves from an antenna light over planes, as far as rays found that they
// do (lit_planes.h), and for each pair of ways to and from it of which at least one goes over such planes.
//
// A path over planes alone and then by physical optics off the last face leaves out the fringe of that face's edges, as the
// direct echo does: that is the path over the planes to an edge, and directly on. It has the share of its order (and its
// reversal the share of the opposite one), as the echoes of rays have (connect/mirror_orders.h), because the fringe is what
// physical optics leaves out in just this order: with a mirror behind the edge, the field of that mirror has the diffraction
// of the edge already. Waves that come and go over planes have both. The blocks follow each other by edges. Raises Cancelled.
std::vector<PathBlock> find_edges_over_planes(const EdgeQuery& query, const LitPlanes& lit, Job* job = nullptr);

}  // namespace echopath
