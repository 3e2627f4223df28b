#pragma once
// A soup holds the content of a mesh file before it becomes meshes. Internal to the module.
#include <cstdint>
#include <istream>
#include <string>
#include <vector>

#include "echopath/scene/mesh/mesh.h"

namespace echopath {

constexpr uint32_t kNoNormal = 0xFFFFFFFF;
constexpr Triangle kNoNormals = {kNoNormal, kNoNormal, kNoNormal};

struct Soup {
  std::vector<Vec3> vertices;            // [V] in file units
  std::vector<uint32_t> corners;         // indices into vertices, polygon by polygon as the file has them
  std::vector<uint32_t> num_corners;     // [P] of each polygon
  std::vector<Triangle> triangles;       // [F]
  std::vector<uint32_t> face;            // [F] face of the file, from 0; a polygon gives several triangles
  std::vector<uint32_t> group;           // [F] index into group_names
  std::vector<std::string> group_names;  // "" where the file gives no name
  std::vector<std::string>
      object_names;                // of what each group belongs to, "" for nothing; [0] where the format has no objects
  std::vector<uint32_t> material;  // [F] index into material_names; [0] where the format has no materials
  std::vector<std::string> material_names;
  std::vector<std::string> material_files;  // that the file names, such as those of `mtllib`
  std::vector<Vec3> normals;                // that the file gives, of any length
  std::vector<Triangle> normal;             // [<= F] indices into normals of the corners, kNoNormal without
  std::vector<uint32_t> smoothing;          // [F] smoothing group, 0 without; [0] where the format has none

  uint32_t num_faces() const { return static_cast<uint32_t>(num_corners.size()); }

  // Appends a polygon of three corners or more, cut into triangles (triangulate.h); its corners must be below the number of
  // vertices. `its_normals` are indices into normals or kNoNormal, one for each corner, or none at all.
  void add_polygon(const std::vector<uint32_t>& polygon, uint32_t group_index,
                   const std::vector<uint32_t>& its_normals = {});
};

// All read `stream` to its end; `name` is what messages call it. All raise FileError with that name, and the line where
// the format is text, also for a coordinate that is not finite. STL files are binary or text, OFF files text.
Soup read_obj(std::istream& stream, const std::string& name);
Soup read_ply(std::istream& stream, const std::string& name);
Soup read_stl(std::istream& stream, const std::string& name);
Soup read_off(std::istream& stream, const std::string& name);

}  // namespace echopath
