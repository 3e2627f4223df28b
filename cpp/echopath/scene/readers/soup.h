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
  uint32_t num_faces = 0;

  // Appends a polygon of three corners or more, cut into triangles (triangulate.h); corners must be below the number of
  // vertices.
  void add_polygon(const std::vector<uint32_t>& corners, uint32_t group_index);
};

// Both read `stream` to its end; `name` is what messages call it. Both raise FileError with that name, and the line where
// the format is text, also for a coordinate that is not finite.
Soup read_obj(std::istream& stream, const std::string& name);
Soup read_ply(std::istream& stream, const std::string& name);

}  // namespace echopath
