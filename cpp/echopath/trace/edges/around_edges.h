#pragma once
// Finds what waves bring around one edge each to points that an antenna does not see: diffraction into shadows.
//
// The field is that of the uniform theory of diffraction (em/edges/edge_shadow.h) about Keller's point of each edge, by
// stationary phase along it; what comes around several edges, as those on both sides of a board, adds up with its phases.
// All edges of bodies count as those of perfect conductors: the part that follows from the shadow, which is most of it near
// the shadow's boundary, is that of any opaque body. Sheets and meshes that deform have none. An edge sends nothing along
// its own faces: what comes to their points from their own edges belongs to the body's echo, which its rays and edges make;
// what comes to other bodies that are flush with them is left out.
#include <vector>

#include "echopath/base/geometry.h"
#include "echopath/base/threads/job.h"
#include "echopath/scene/scene.h"

namespace echopath {

// Describes the scene and the antenna from which waves go around edges.
struct AroundQuery {
  const Scene& scene;  // outlives the query
  double time;         // s
  double frequency;    // Hz
  Vec3 antenna;        // m, world
  Vec3 polarization;   // unit vector, world
  bool edges = true;   // whether legs around edges are looked for, or only whether the points are seen
};

// Holds the strongest leg around one edge, and what all of them bring.
struct LegAroundEdge {
  uint32_t mesh_id = kNoMesh;  // whose edge; kNoMesh: nothing is in the way, or no edge leads there
  Vec3 point = Vec3::Zero();   // m, world: on the edge
  double length = 0.0;         // m, of the leg
  double share = 0.0;          // of the field that would arrive were nothing in its way, of all edges; 1 where nothing is
};

// Returns a leg for each point (m, world). Raises invalid_argument when a motion is not defined at the time, Cancelled when
// the job is cancelled.
std::vector<LegAroundEdge> legs_around_edges(const AroundQuery& query, const std::vector<Vec3>& points, Job* job);

}  // namespace echopath
