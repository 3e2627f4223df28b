#pragma once
// Which vertices of deforming meshes a record needs.
#include <vector>

#include "echopath/scene/surface_patch.h"
#include "echopath/trace/record/paths.h"

namespace echopath {

// By mesh ID: the corners of the triangles that the paths hit, and where the mesh is smooth their neighbours; empty for
// meshes that do not deform. Costs one look at each hit and triangle, and nothing where no mesh deforms.
std::vector<SurfacePatch> hit_patches(const Paths& paths);

// Of whole meshes, for those who leave the triangles that were hit.
std::vector<SurfacePatch> whole_patches(const Scene& scene);

}  // namespace echopath
