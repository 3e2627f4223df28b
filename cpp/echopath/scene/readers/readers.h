#pragma once
// Reads mesh files in double precision.
#include <istream>
#include <string>
#include <vector>

#include "echopath/scene/mesh/mesh.h"

namespace echopath {

struct NamedMesh {
  std::string name;  // of the file's group, object/group of one within an object, object/rest of what lies in an object with
                     // groups but in none of them, or the file's stem where it has none
  MeshPtr mesh;
};

// Reads OBJ (each group `g` of an object `o`, or the object where there is no group, becomes a mesh; groups of equal names
// are merged within an object; polygons are cut into triangles), PLY (ASCII, binary little and big endian; any number
// type), STL (text, each `solid` of which becomes a mesh, or binary; corners of equal coordinates are one vertex) or OFF
// (text), as the file's extension says. `unit` is in metres per file unit. original_triangle() of the meshes counts the
// faces of the file from 0. A group without any area is left out. Raises FileError naming the file and, in text formats, the
// line; raises invalid_argument for unit <= 0.
std::vector<NamedMesh> load_meshes(const std::string& path, double unit = 1.0);

// Reads the same from a stream that is open already. `name` stands for the path: its extension tells the format, and
// messages begin with it.
std::vector<NamedMesh> read_meshes(std::istream& stream, const std::string& name, double unit = 1.0);

// Holds what a file says of surfaces and their materials.
struct Surfaces {
  struct Surface {
    std::string object;               // that the group lies in, "" for none
    std::string name;                 // of the group, or the file's stem where it has none
    std::string material;             // its name in the file, "" without one
    std::vector<Vec3> vertices;       // [V] in m, in the order of the file
    std::vector<Triangle> triangles;  // [F] indices of vertices; some may have no area
    std::vector<uint32_t> face;       // [F] of the file, from 0
    std::vector<Vec3> normals;        // [3 F] of unit length, of the corners; [0] where the file says nothing of them
  };
  std::vector<Surface> surfaces;
  std::vector<std::string> material_files;  // that an OBJ file names by `mtllib`; they are not read
};

// Reads what load_meshes reads, but groups whose faces have several materials (`usemtl`) become a surface for each of them.
Surfaces load_surfaces(const std::string& path, double unit = 1.0);
Surfaces read_surfaces(std::istream& stream, const std::string& name, double unit = 1.0);

// Holds surfaces that move from file to file.
struct SurfaceFrames {
  std::vector<Surfaces::Surface> surfaces;               // of the first file
  std::vector<std::vector<std::vector<Vec3>>> vertices;  // [surface][file][V] in m
};

// Reads files whose vertices move: faces, groups and materials are those of the first one, cut into triangles as it stands
// there. A group without a name, or named after its file, is the same in all. Raises FileError naming a file whose faces,
// groups or materials are others; raises invalid_argument for no file at all.
SurfaceFrames load_frames(const std::vector<std::string>& paths, double unit = 1.0);

// Reads all groups of a file as one mesh.
MeshPtr load_mesh(const std::string& path, double unit = 1.0);

// Returns the extensions of the files that these functions read, in small letters, such as ".obj".
std::vector<std::string> mesh_extensions();

}  // namespace echopath
