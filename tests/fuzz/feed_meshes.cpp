#include <cmath>
#include <sstream>

#include "echopath/base/errors.h"
#include "echopath/scene/readers/readers.h"
#include "fuzz/targets.h"

namespace echopath::fuzz {
namespace {

void check(const Surfaces::Surface& one) {
  demand(!one.name.empty(), "a surface has a name");
  for (const std::string& name : {one.object, one.name, one.material}) {
    demand(name.find('\0') == std::string::npos, "names have no NUL");
  }
  demand(!one.triangles.empty(), "a surface has triangles");
  for (const Vec3& vertex : one.vertices) demand(vertex.allFinite(), "vertices are finite");
  for (const Triangle& triangle : one.triangles) {
    for (const uint32_t vertex : triangle) demand(vertex < one.vertices.size(), "corners are vertices");
  }
  demand(one.face.size() == one.triangles.size(), "each triangle has a face of the file");
  demand(one.normals.empty() || one.normals.size() == 3 * one.triangles.size(), "all corners have normals, or none");
  for (const Vec3& normal : one.normals) demand(normal.allFinite() && normal.norm() < 1.001, "normals are units, or zero");
}

void check(const NamedMesh& named) {
  const Mesh& mesh = *named.mesh;
  demand(!named.name.empty(), "a mesh has a name");
  demand(!mesh.triangles().empty(), "a mesh has triangles");
  demand(mesh.original_triangle().size() == mesh.triangles().size(), "each triangle of a mesh has a face of the file");
  demand(std::isfinite(mesh.area()) && mesh.area() > 0.0, "a mesh has an area");
}

void feed(std::string_view bytes, const std::string& name) {
  std::istringstream stream{std::string(bytes)};
  try {
    for (const Surfaces::Surface& one : read_surfaces(stream, name).surfaces) check(one);
    std::istringstream again{std::string(bytes)};
    for (const NamedMesh& named : read_meshes(again, name)) check(named);
  } catch (const FileError& error) {
    demand(std::string_view(error.what()).starts_with(name), "an error names its file");
  }
}

}  // namespace

void feed_obj(std::string_view bytes) { feed(bytes, "mesh.obj"); }
void feed_ply(std::string_view bytes) { feed(bytes, "mesh.ply"); }
void feed_stl(std::string_view bytes) { feed(bytes, "mesh.stl"); }
void feed_off(std::string_view bytes) { feed(bytes, "mesh.off"); }

}  // namespace echopath::fuzz
