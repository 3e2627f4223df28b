#pragma once
// A soup holds the content of a mesh file before it becomes meshes. Internal to the module.
#include <cstdint>
#include <istream>
#include <string>
#include <vector>

#include "echopath/scene/mesh/mesh.h"

namespace echopath {

struct Soup {
  std::vector<Vec3> vertices;            // [V] in file units
  std::vector<Triangle> triangles;       // [F]
  std::vector<uint32_t> face;            // [F] face of the file, from 0; a polygon gives several triangles
  std::vector<uint32_t> group;           // [F] index into group_names
  std::vector<std::string> group_names;  // "" where the file gives no name
  std::vector<uint32_t> material;        // [F] index into material_names; [0] where the format has no materials
  std::vector<std::string> material_names;
  std::vector<std::string> material_files;  // that the file names, such as those of `mtllib`
  uint32_t num_faces = 0;

  // Appends a polygon of three corners or more, cut into triangles (triangulate.h); corners must be below the number of
  // vertices.
  void add_polygon(const std::vector<uint32_t>& corners, uint32_t group_index);
};

// All read `stream` to its end; `name` is what messages call it. All raise FileError with that name, and the line where
// the format is text, also for a coordinate that is not finite. STL files are binary or text, OFF files text.
Soup read_obj(std::istream& stream, const std::string& name);
Soup read_ply(std::istream& stream, const std::string& name);
Soup read_stl(std::istream& stream, const std::string& name);
Soup read_off(std::istream& stream, const std::string& name);

}  // namespace echopath
