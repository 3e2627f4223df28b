#pragma once
// Reads mesh files in double precision.
#include <istream>
#include <string>
#include <vector>

#include "echopath/scene/mesh/mesh.h"

namespace echopath {

struct NamedMesh {
  std::string name;  // group name of the file, or the file's stem where it has none
  MeshPtr mesh;
};

// Reads OBJ (each group `g`, or object `o` where there is no group, becomes a mesh; groups of equal names are merged;
// polygons are cut into triangles), PLY (ASCII, binary little and big endian; any number type), STL (text, each `solid` of
// which becomes a mesh, or binary; corners of equal coordinates are one vertex) or OFF (text), as the file's extension says.
// `unit` is in metres per file unit. original_triangle() of the meshes counts the faces of the file from 0. A group without
// any area is left out. Raises FileError naming the file and, in text formats, the line; raises invalid_argument for
// unit <= 0.
std::vector<NamedMesh> load_meshes(const std::string& path, double unit = 1.0);

// Reads the same from a stream that is open already. `name` stands for the path: its extension tells the format, and
// messages begin with it.
std::vector<NamedMesh> read_meshes(std::istream& stream, const std::string& name, double unit = 1.0);

// Holds what a file says of surfaces and their materials.
struct Surfaces {
  struct Surface {
    std::string name;      // as of NamedMesh
    std::string material;  // its name in the file, "" without one
    MeshPtr mesh;
  };
  std::vector<Surface> surfaces;
  std::vector<std::string> material_files;  // that an OBJ file names by `mtllib`; they are not read
};

// Reads as load_meshes does, but groups whose faces have several materials (`usemtl`) become a mesh for each of them.
Surfaces load_surfaces(const std::string& path, double unit = 1.0);
Surfaces read_surfaces(std::istream& stream, const std::string& name, double unit = 1.0);

// Reads all groups of a file as one mesh.
MeshPtr load_mesh(const std::string& path, double unit = 1.0);

}  // namespace echopath
