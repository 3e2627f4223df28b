#include <cmath>
#include <sstream>

#include "echopath/base/errors.h"
#include "echopath/scene/readers/readers.h"
#include "fuzz/targets.h"

namespace echopath::fuzz {
namespace {

void check(const std::string& name, const Mesh& mesh) {
  demand(!name.empty() && name.find('\0') == std::string::npos, "a mesh has a name without NUL");
  demand(!mesh.triangles().empty(), "a mesh has triangles");
  for (const Vec3& vertex : mesh.vertices()) demand(vertex.allFinite(), "vertices are finite");
  for (const Triangle& triangle : mesh.triangles()) {
    for (const uint32_t vertex : triangle) demand(vertex < mesh.vertices().size(), "corners are vertices");
  }
  demand(mesh.original_triangle().size() == mesh.triangles().size(), "each triangle has a face of the file");
  demand(std::isfinite(mesh.area()) && mesh.area() > 0.0, "a mesh has an area");
}

void feed(std::string_view bytes, const std::string& name) {
  std::istringstream stream{std::string(bytes)};
  try {
    for (const Surfaces::Surface& one : read_surfaces(stream, name).surfaces) {
      check(one.name, *one.mesh);
      demand(one.material.find('\0') == std::string::npos, "the name of a material has no NUL");
    }
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
