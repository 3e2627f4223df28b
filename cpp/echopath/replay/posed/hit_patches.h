#pragma once
// Finds which vertices of deforming meshes a record needs.
#include <vector>

#include "echopath/record/paths.h"
#include "echopath/scene/mesh/surface_patch.h"

namespace echopath {

// Returns by mesh ID the corners of the triangles that the paths hit and, where the mesh is smooth, their neighbours; it is
// empty for meshes that do not deform. It looks once at each hit and triangle, and costs nothing where no mesh deforms.
std::vector<SurfacePatch> hit_patches(const Paths& paths);

// Returns the patches of whole meshes, for paths that leave the triangles that were hit.
std::vector<SurfacePatch> whole_patches(const Scene& scene);

}  // namespace echopath
