#pragma once
// Visits the meshes that a path touches.
#include "echopath/record/paths.h"

namespace echopath {

// Calls visit(mesh_id) for each hit of a path and each sheet that it passes.
template <class Visit>
void visit_meshes(const Paths& paths, int64_t path, const Visit& visit) {
  const Hit* const hits = paths.hits_of(path);
  for (int k = 0; k < paths.num_bounces[path]; ++k) visit(hits[k].mesh_id);
  for (const Pass& pass : paths.passes_of(path)) visit(pass.hit.mesh_id);
}

}  // namespace echopath
