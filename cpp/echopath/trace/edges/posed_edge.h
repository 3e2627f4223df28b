#pragma once
// Poses a sharp edge of a mesh: the wedge that its faces make in the world.
#include "echopath/em/edge_diffraction.h"
#include "echopath/em/material.h"
#include "echopath/posed/posed_scene.h"
#include "echopath/scene/mesh/sharp_edges.h"

namespace echopath {

// Returns the wedge in the axes of the world, at the time of the scene.
Wedge posed_wedge(const SharpEdge& edge, const PosedScene& scene, uint32_t mesh_id);

// Holds an edge in the world, relative to the origin of a trace.
struct PosedEdge {
  uint32_t mesh_id;
  SharpEdge edge;  // in the frame of its mesh
  Wedge wedge;
  Vec3 from, to;  // m, the ends of its stretch in the direction of the triangle's side
};

// Returns the unit vector along an edge about which the angles of its wedge count.
Vec3 axis_of(const Wedge& wedge);

// Returns the share of a field that the faces keep in phase: as the one that faces the antenna more would mirror it at a
// frequency in Hz.
double kept_share(const Material& material, double frequency, const Wedge& wedge, const Vec3& to_antenna);

// Returns the unit vector across an edge that leads away from both faces.
Vec3 outward_of(const Wedge& wedge);

}  // namespace echopath
