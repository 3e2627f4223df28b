#pragma once
// Poses the sharp edges of meshes: where they are in the world, and the wedges that their faces make there.
#include <array>
#include <vector>

#include "echopath/em/edges/edge_diffraction.h"
#include "echopath/em/material.h"
#include "echopath/posed/posed_scene.h"
#include "echopath/record/paths.h"
#include "echopath/scene/scene_edges.h"

namespace echopath {

// Returns the wedge in the axes of the world, at the time of the scene.
Wedge posed_wedge(const SharpEdge& edge, const PosedScene& scene, uint32_t mesh_id);

// Holds an edge in the world, relative to an origin.
struct PosedEdge {
  uint32_t mesh_id;
  SharpEdge edge;  // in the frame of its mesh
  Wedge wedge;
  Vec3 from, to;  // m, the ends of its stretch in the direction of the triangle's side

  Vec3 line() const { return to - from; }
};

// Returns an edge of a mesh at the time of the pose, relative to `origin` (m, world).
PosedEdge posed_edge(const SharpEdge& edge, const Scene& scene, const PosedScene& pose, uint32_t mesh_id,
                     const Vec3& origin);

// Returns all edges of a scene at the time of the pose, in the order of meshes and edges, relative to `origin` (m, world).
std::vector<PosedEdge> posed_edges(const Scene& scene, const PosedScene& pose, const Vec3& origin);

// Returns how long a piece of an edge may be (m) for the wave fronts to and from two antennas, so that their phases depart
// from linear ones by at most `quadratic_phase` (rad) across half of it.
double longest_piece(const PosedEdge& edge, const Vec3& transmitter, const Vec3& receiver, double wavenumber,
                     double quadratic_phase);

// Holds a point on an edge, as a record has it.
struct EdgePoint {
  Hit hit;
  Vec3 position;  // m
};
// Returns the point at `along` in [0, 1] of an edge. The corners are those of its triangle.
EdgePoint point_on_edge(const PosedEdge& edge, double along, const std::array<Vec3, 3>& corners);

// Returns the share of a field that the faces keep in phase: as the one that faces the antenna more would mirror it at a
// frequency in Hz.
double kept_share(const Material& material, double frequency, const Wedge& wedge, const Vec3& to_antenna);

// Returns whether a wave may leave an edge toward an antenna at that distance (m): it stands in the space around the edge
// and not near it.
bool may_leave(const Wedge& wedge, const Vec3& to_antenna, double distance);

// Returns the unit vector across an edge that leads away from both faces.
Vec3 outward_of(const Wedge& wedge);

}  // namespace echopath
