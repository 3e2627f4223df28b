#pragma once
// Finds the echoes of sharp edges behind and before mirrors that nobody flagged: in corners, ducts and boxes.
#include <vector>

#include "echopath/trace/edges/edge_paths.h"
#include "echopath/trace/edges/plane_legs.h"

namespace echopath {

// Returns one path for each piece of an edge whose face waves from an antenna light over planes, as far as rays found that
// they do (lit_planes.h), and for each pair of ways to and from it of which at least one goes over such planes.
//
// Physical optics off a face that is lit over planes leaves out the fringe of that face's edges: the path over the planes to
// an edge, and directly on. It has the share of its order, and its reversal that of the opposite one, as the echoes of rays
// have (connect/mirror_orders.h). On a way from an edge to a plane, where that plane is a mirror, the edge sends what the
// uniform theory of diffraction says (kPastEdge): the mirror goes on with the face in the corner, where physical optics and
// its fringe would have the face's current end. Waves that come and go over planes have the fringe. What is
// below the least power is left out. The blocks follow each other by edges. Raises Cancelled.
std::vector<PathBlock> find_edges_over_planes(const EdgeQuery& query, const LitPlanes& lit, Job* job = nullptr);

}  // namespace echopath
