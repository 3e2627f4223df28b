#pragma once
// Finds the echoes of sharp edges behind and before mirrors that nobody flagged: in corners, ducts and boxes.
#include <vector>

#include "echopath/trace/edges/edge_paths.h"
#include "echopath/trace/edges/plane_legs.h"

namespace echopath {

// Returns one path for each piece of an edge whose face waves from an antenna light over planes, as far as rays found that
// they do (lit_planes.h), and for each pair of legs to and from it of which at least one goes over such planes.
//
// Physical optics gives the echo of a face that is lit over planes, but not the fringe wave of the face's edges. Three kinds
// of paths add what is missing:
// 1. The wave comes to the edge over planes and returns directly. The path carries the fringe wave times the share of its
//    order, and its reversal carries the fringe wave times the share of the opposite order, as the echoes of rays do
//    (connect/mirror_orders.h).
// 2. The wave comes to the edge directly and goes on to a plane that is a mirror. The path carries the field that the edge
//    sends by the uniform theory of diffraction (kPastEdge): the mirror continues the face in the corner, whereas physical
//    optics with its fringe wave has the current end at the edge.
// 3. The wave comes and returns over planes. The path carries the fringe wave.
// Paths below the least power are left out. The blocks follow each other by edges. Raises Cancelled.
std::vector<PathBlock> find_edges_over_planes(const EdgeQuery& query, const LitPlanes& lit, Job* job);

}  // namespace echopath
