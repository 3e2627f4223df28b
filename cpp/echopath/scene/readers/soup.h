#pragma once
// A soup holds the content of a mesh file before it becomes meshes. Internal to the module.
#include <cstdint>
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

  // Appends a polygon of three corners or more, cut into triangles; corners must be below the number of vertices.
  void add_polygon(const std::vector<uint32_t>& corners, uint32_t group_index);
};

// Cuts a simple polygon `corners` (indices into `vertices`) into triangles of the same direction: a fan where it is
// convex, else ear by ear. A polygon that crosses itself is cut into a fan.
std::vector<Triangle> triangulate(const std::vector<Vec3>& vertices, const std::vector<uint32_t>& corners);

// Both raise FileError naming the file, and the line where the format is text.
Soup read_obj(const std::string& path);
Soup read_ply(const std::string& path);

}  // namespace echopath
