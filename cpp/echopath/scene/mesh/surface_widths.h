#pragma once
// Measures how wide surfaces are.
#include <unordered_map>

#include "echopath/scene/mesh/mesh.h"

namespace echopath {

// Remembers what many meshes are measured by.
class SurfaceWidths {
 public:
  // Returns the middle one of the extents in m of a mesh along its principal axes: the width of a plate, the diameter of a
  // rod or sphere. A part has that of the whole surface. `vertices` are those of the mesh in the world, by whose extent the
  // whole is scaled.
  double width_of(const Mesh& mesh, const std::vector<Vec3>& vertices);

 private:
  double width_of_whole(const Mesh& whole);

  std::unordered_map<const Mesh*, double> at_rest_;  // of wholes, which parts share
};

}  // namespace echopath
