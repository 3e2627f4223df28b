#pragma once
// Finds which meshes the paths of a record touch, and which vertices they need of those that deform.
#include "echopath/posed/mesh_places.h"
#include "echopath/record/paths.h"

namespace echopath {

// Returns the meshes on which paths have hits or passages. The patches of those that deform hold the corners of the
// triangles that are hit and, where the mesh is smooth, their neighbours. It looks once at each hit, but where nothing
// moves and paths are so many that this would take longer than to pose all meshes: it returns these then.
MeshesToPose touched_meshes(const Paths& paths);

// Returns all meshes as a whole, for paths that leave the triangles that were hit.
MeshesToPose whole_meshes(const Scene& scene);

}  // namespace echopath
