#pragma once
// Tells how far the facets of a mesh stray from the curved surface that they stand for.
#include <optional>
#include <vector>

#include "echopath/scene/scene.h"

namespace echopath {

// Finds the phases of the meshes of a scene when they are asked for. The scene must outlive it.
class FacetPhases {
 public:
  // `wavenumber`: rad/m; `time`: s, of the trace.
  FacetPhases(const Scene& scene, double wavenumber, double time);
  // Returns the phase, rad, that a wave reflected at normal incidence gains between the facets of a smooth mesh and its
  // surface, mean over the area; 0 for a mesh whose facets are what they are. It takes an even sample of the facets with the
  // shape that the mesh has at rest, and leaves out those at creases.
  double of(uint32_t mesh_id);

 private:
  const Scene& scene_;
  const double wavenumber_;
  const double time_;                         // s
  std::vector<Transform> world_from_nodes_;   // from the first smooth mesh on that is asked for
  std::vector<std::optional<double>> found_;  // by mesh ID
};

}  // namespace echopath
