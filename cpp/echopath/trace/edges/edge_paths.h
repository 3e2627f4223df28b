#pragma once
// Finds the echoes of sharp edges of first order: from the transmitter, directly or over flagged mirrors, to a point on an
// edge and likewise on to the receiver.
#include <vector>

#include "echopath/base/job.h"
#include "echopath/posed/posed_scene.h"
#include "echopath/trace/mirrors/antenna_frusta.h"
#include "echopath/trace/record/path_block.h"

namespace echopath {

struct EdgeQuery {
  const Scene& scene;
  const PosedScene& pose;
  const EmbreeScene& geometry;
  const std::vector<Mirror>& mirrors;
  const SbrSettings& settings;
  const AntennaFrusta& frusta;
};

// Returns the edges of a mesh that make echoes: those of conductors, or of surfaces that reflect like conductors. Flagged
// mirrors, which stand for planes without end, and meshes that deform or change their scale have none.
std::vector<SharpEdge> echoing_edges(const Scene& scene, uint32_t mesh_id);

// Returns one path for each piece of an edge and each pair of ways to and from it that are free at the middle of the piece,
// in the order of meshes, edges and pieces. Pieces are so short that the wave fronts are flat across them (to .1 rad), and
// at most a sixteenth of the mesh long, so that shadows end near where they should. Raises Cancelled when the job is
// cancelled.
std::vector<PathBlock> find_edge_paths(const EdgeQuery& query, Job* job = nullptr);

}  // namespace echopath
