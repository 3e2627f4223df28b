#pragma once
// Poses a sharp edge of a mesh: the wedge that its faces make in the world.
#include "echopath/em/edge_diffraction.h"
#include "echopath/posed/posed_scene.h"
#include "echopath/scene/mesh/sharp_edges.h"

namespace echopath {

// Returns the wedge in the axes of the world, at the time of the scene.
Wedge posed_wedge(const SharpEdge& edge, const PosedScene& scene, uint32_t mesh_id);

// Returns the unit vector across an edge that leads away from both faces.
Vec3 outward_of(const Wedge& wedge);

}  // namespace echopath
