#include "echopath/record/posed_edge.h"

#include <algorithm>
#include <cmath>

#include "echopath/em/surface/surface_response.h"
#include "echopath/record/near_antenna.h"

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

PosedEdge posed_edge(const SharpEdge& edge, const Scene& scene, const PosedScene& pose, uint32_t mesh_id,
                     const Vec3& origin) {
  const Mesh& mesh = *scene.node_of(mesh_id).mesh;
  const Vec3 translation = pose.world_translation(mesh_id) - origin;
  const auto corner = [&](uint32_t index) -> Vec3 {
    return pose.linear(mesh_id) * mesh.vertices()[mesh.triangles()[edge.triangle][index]] + translation;
  };
  const Vec3 from = corner(edge.side), line = corner((edge.side + 1) % 3) - from;
  return {mesh_id, edge, posed_wedge(edge, pose, mesh_id), from + edge.begin * line, from + edge.end * line};
}

std::vector<PosedEdge> posed_edges(const Scene& scene, const PosedScene& pose, const Vec3& origin) {
  const SceneEdges edges(scene);
  std::vector<PosedEdge> found;
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) {
    for (const SharpEdge& edge : edges.of(id)) found.push_back(posed_edge(edge, scene, pose, id, origin));
  }
  return found;
}

double longest_piece(const PosedEdge& edge, const Vec3& transmitter, const Vec3& receiver, double wavenumber,
                     double quadratic_phase) {
  const auto inverse = [&](const Vec3& antenna) {
    return 1.0 / std::max(distance_to_segment(antenna, edge.from, edge.to), kNearAntenna);
  };
  return std::sqrt(8.0 * quadratic_phase / (wavenumber * (inverse(transmitter) + inverse(receiver))));
}

EdgePoint point_on_edge(const PosedEdge& edge, double along, const std::array<Vec3, 3>& corners) {
  const SharpEdge& side = edge.edge;
  const PointOnSide at = point_on_side(side.side, side.begin + (side.end - side.begin) * along);
  return {{edge.mesh_id, side.triangle, at.u, at.v},
          corners[0] + double{at.u} * (corners[1] - corners[0]) + double{at.v} * (corners[2] - corners[0])};
}

double kept_share(const Material& material, double frequency, const Wedge& wedge, const Vec3& to_antenna) {
  const double cosine = std::max(to_antenna.dot(wedge.faces[0].normal), to_antenna.dot(wedge.faces[1].normal));
  const SurfaceResponse response = respond(material, frequency, std::clamp(cosine, 0.0, 1.0), PolarizationMode::kTe);
  return std::abs(response.gamma) * response.coherent;
}

bool may_leave(const Wedge& wedge, const Vec3& to_antenna, double distance) {
  return reaches_antenna(distance) && is_outside(wedge, to_antenna);
}

Vec3 outward_of(const Wedge& wedge) {
  return (wedge.faces[0].normal + wedge.faces[1].normal - wedge.faces[0].inward - wedge.faces[1].inward).normalized();
}

}  // namespace echopath
