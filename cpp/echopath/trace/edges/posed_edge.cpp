#include "echopath/trace/edges/posed_edge.h"

#include <algorithm>

#include "echopath/em/surface_response.h"

namespace echopath {
namespace {

// Normals stay on the side of the space around the edge, through reflections too.
WedgeFace posed_face(const SharpEdge& edge, int face, const PosedScene& scene, uint32_t mesh_id) {
  const Mat3& linear = scene.linear(mesh_id);
  const Vec3 along = (linear * edge.inward[face].cross(edge.normal[face])).normalized(), inward = linear * edge.inward[face];
  const Vec3 normal = scene.normal_matrix(mesh_id) * edge.normal[face];
  return {(inward - along.dot(inward) * along).normalized(),
          (linear.determinant() < 0 ? Vec3(-normal) : normal).normalized()};
}

}  // namespace

Wedge posed_wedge(const SharpEdge& edge, const PosedScene& scene, uint32_t mesh_id) {
  return wedge_between(posed_face(edge, 0, scene, mesh_id), posed_face(edge, 1, scene, mesh_id));
}

Vec3 axis_of(const Wedge& wedge) { return wedge.faces[0].inward.cross(wedge.faces[0].normal); }

double kept_share(const Material& material, double frequency, const Wedge& wedge, const Vec3& to_antenna) {
  const double cosine = std::max(to_antenna.dot(wedge.faces[0].normal), to_antenna.dot(wedge.faces[1].normal));
  const SurfaceResponse response = respond(material, frequency, std::clamp(cosine, 0.0, 1.0), PolarizationMode::kTe);
  return std::abs(response.gamma) * response.coherent;
}

Vec3 outward_of(const Wedge& wedge) {
  return (wedge.faces[0].normal + wedge.faces[1].normal - wedge.faces[0].inward - wedge.faces[1].inward).normalized();
}

}  // namespace echopath
