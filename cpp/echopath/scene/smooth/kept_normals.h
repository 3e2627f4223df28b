#pragma once
// Keeps the vertex normals of meshes while these live: each pose of a scene and each replay asks for them again.
#include <memory>
#include <vector>

#include "echopath/scene/mesh/mesh.h"

namespace echopath {

// Returns vertex_normals(*mesh), made once. Memory: 24 bytes a vertex, and for a while as much again of meshes that are no
// more. Thread-safe.
std::shared_ptr<const std::vector<Vec3>> kept_vertex_normals(const MeshPtr& mesh);

}  // namespace echopath
