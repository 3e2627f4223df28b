#include "echopath/scene/mesh/surface_patch.h"

#include <algorithm>

namespace echopath {
namespace {

// Marks the vertices [V of the surface] that are corners of the triangles taken.
std::vector<uint8_t> used_as_corners(const Mesh& mesh, const std::vector<uint8_t>& takes) {
  std::vector<uint8_t> is_corner(mesh.surface().vertices().size(), 0);
  for (size_t t = 0; t < takes.size(); ++t) {
    if (!takes[t]) continue;
    for (const uint32_t vertex : mesh.triangles()[t]) is_corner[mesh.surface_vertex(vertex)] = 1;
  }
  return is_corner;
}

// Returns the triangles of the surface that have a corner among the marked vertices.
std::vector<Triangle> ring_of(const Mesh& surface, const std::vector<uint8_t>& is_corner) {
  std::vector<Triangle> ring;
  std::copy_if(surface.triangles().begin(), surface.triangles().end(), std::back_inserter(ring),
               [&](const Triangle& t) { return is_corner[t[0]] || is_corner[t[1]] || is_corner[t[2]]; });
  return ring;
}

}  // namespace

SurfacePatch make_patch(const Mesh& mesh, const std::vector<uint8_t>& takes, bool with_normals) {
  const Mesh& surface = mesh.surface();
  const std::vector<uint8_t> is_corner = used_as_corners(mesh, takes);
  SurfacePatch patch;
  if (with_normals) patch.triangles = ring_of(surface, is_corner);
  std::vector<uint8_t> is_needed = is_corner;
  for (const Triangle& triangle : patch.triangles) {
    for (const uint32_t vertex : triangle) is_needed[vertex] = 1;
  }
  std::vector<Vec3> at_rest;  // [n] vertices
  std::vector<uint32_t> place_in_surface(is_needed.size(), SurfacePatch::kAbsent);
  for (size_t v = 0; v < is_needed.size(); ++v) {
    if (!is_needed[v]) continue;
    place_in_surface[v] = static_cast<uint32_t>(patch.original_vertex.size());
    patch.original_vertex.push_back(surface.original_vertex()[v]);
    at_rest.push_back(surface.vertices()[v]);
  }
  for (Triangle& triangle : patch.triangles) {
    for (uint32_t& vertex : triangle) vertex = place_in_surface[vertex];
  }
  if (with_normals) patch.creases = find_creases(at_rest, patch.triangles);
  for (uint32_t v = 0; v < mesh.vertices().size(); ++v) {
    const uint32_t of_surface = mesh.surface_vertex(v);
    patch.place.push_back(is_corner[of_surface] ? place_in_surface[of_surface] : SurfacePatch::kAbsent);
  }
  return patch;
}

}  // namespace echopath
