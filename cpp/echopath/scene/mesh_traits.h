#pragma once
// Tells what reports ask of every mesh of a scene, so that they need not look at meshes one by one.
#include <cstdint>
#include <vector>

#include "echopath/scene/scene.h"

namespace echopath {

struct MeshTraits {
  std::vector<MaterialPtr> materials;              // of all meshes, each once
  std::vector<uint32_t> material;                  // [M] of each mesh, index into `materials`
  std::vector<uint8_t> smooth, moving, deforming;  // [M] whether it is marked smooth, moves at some time, deforms
};

// Returns the traits of the meshes [M] that take part, by mesh ID.
MeshTraits mesh_traits(const Scene& scene);

}  // namespace echopath
