#pragma once
// Finds the echoes of sharp edges: from the transmitter, directly or over flagged mirrors, to a point on an edge, from there
// over flat faces to other edges, and likewise on to the receiver.
#include <span>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/record/blocks/path_block.h"
#include "echopath/trace/edges/edge_power.h"
#include "echopath/trace/frusta/antenna_frusta.h"

namespace echopath {

struct EdgeQuery {
  const Scene& scene;
  std::span<const PosedEdge> edges;  // of the scene, as they stand
  const EdgeEstimate& estimate;
  double least_power;  // W: echoes that are weaker by the estimate are left out
  const EmbreeScene& geometry;
  const std::vector<Mirror>& mirrors;
  const SbrSettings& settings;
  const AntennaFrusta& frusta;
};

// Returns one path for each piece of an edge and each pair of legs to and from it that are free at the middle of the piece,
// in the order of meshes, edges and pieces. Paths of waves that go on from there over flat faces from edge to edge, up to
// kMostEdges edges, follow as far as the waves are no weaker than .03 of what the edge of a half plane sends. Paths below
// the least power are left out. Pieces are so short that the phase across half of one departs from a linear phase by at most
// .8 rad (edge_filter), and where a part of an edge is hidden they are at most a sixteenth of the body long, so that shadows
// end near where they should. Raises Cancelled when the job is cancelled.
std::vector<PathBlock> find_edge_paths(const EdgeQuery& query, Job* job);

}  // namespace echopath
