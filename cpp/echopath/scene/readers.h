#pragma once
// Mesh files, read in double precision.
#include <string>
#include <vector>

#include "echopath/scene/mesh.h"

namespace echopath {

struct NamedMesh {
  std::string name;  // group name of the file, or the file's stem where it has none
  MeshPtr mesh;
};

// Reads OBJ (each group or object that has faces is a mesh; polygons are triangulated) or PLY (ASCII, binary little and
// big endian; float or double) by the file's extension. `unit`: metres per file unit.
// Raises FileError naming the file and, in text formats, the line; invalid_argument for unit <= 0.
std::vector<NamedMesh> load_meshes(const std::string& path, double unit = 1.0);

// All groups as one mesh.
MeshPtr load_mesh(const std::string& path, double unit = 1.0);

}  // namespace echopath
