#include "echopath/power/interval/facet_phase.h"

#include <array>
#include <cmath>

#include "echopath/scene/smooth/kept_normals.h"
#include "echopath/scene/smooth/smooth.h"

namespace echopath {
namespace {

constexpr size_t kMostFacets = 512;  // of a mesh, looked at

// Returns the mean depth, m, of a curved surface with these normals over a facet. Over a side it is a parabola, whose height
// is an eighth of the side times the turn of the normals along it; the mean over the facet is the sum over its sides of a
// third of that.
double mean_depth(const std::array<Vec3, 3>& corners, const std::array<Vec3, 3>& normals) {
  double sum = 0.0;
  for (size_t i = 0; i < 3; ++i) {
    const size_t next = (i + 1) % 3;
    sum += std::abs((corners[next] - corners[i]).dot(normals[next] - normals[i])) / 8.0;
  }
  return sum / 3.0;
}

// Returns the mean over the area of a mesh in its own frame, m.
double mean_depth(const Mesh& mesh, const std::vector<Vec3>& vertex_normals) {
  const size_t num_facets = mesh.triangles().size(), step = (num_facets + kMostFacets - 1) / kMostFacets;
  double sum = 0.0, area = 0.0;
  for (size_t f = 0; f < num_facets; f += step) {
    const Triangle& triangle = mesh.triangles()[f];
    std::array<Vec3, 3> corners, normals;
    for (size_t i = 0; i < 3; ++i) {
      corners[i] = mesh.vertices()[triangle[i]];
      normals[i] = vertex_normals[triangle[i]];
    }
    const Vec3 across = cross_of_sides(corners);
    const double size = across.norm();
    area += size;
    if (is_smooth_facet(across / size, normals)) sum += size * mean_depth(corners, normals);
  }
  return area > 0.0 ? sum / area : 0.0;
}

}  // namespace

FacetPhases::FacetPhases(const Scene& scene, double wavenumber, double time)
    : scene_(scene), wavenumber_(wavenumber), time_(time), found_(scene.meshes().size()) {}

double FacetPhases::of(uint32_t mesh_id) {
  std::optional<double>& found = found_[mesh_id];
  if (found) return *found;
  const Node& node = scene_.node_of(mesh_id);
  if (!node.smooth || node.mesh->is_flat()) return found.emplace(0.0);
  if (world_from_nodes_.empty()) world_from_nodes_ = world_from_nodes(scene_, time_);
  const Transform& world_from_mesh = world_from_nodes_[scene_.meshes()[mesh_id].node];
  const double scale = std::cbrt(std::abs(world_from_mesh.linear().determinant()));
  return found.emplace(2.0 * wavenumber_ * scale * mean_depth(*node.mesh, *kept_vertex_normals(node.mesh)));
}

}  // namespace echopath
