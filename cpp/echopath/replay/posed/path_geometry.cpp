#include "echopath/replay/posed/path_geometry.h"

#include "echopath/record/posed_edge.h"
#include "echopath/scene/smooth/smooth.h"

namespace echopath {
namespace {

// Moves a posed hit from its facet to the curved surface.
void curve(const LocalHit& hit, const PosedScene& scene, PosedHit& posed) {
  const Vec3 corner = posed.point - hit.u * posed.edge_u - hit.v * posed.edge_v;
  const std::vector<Vec3>& deformed = scene.deformed_normals(hit.mesh_id);
  std::array<Vec3, 3> normals;
  for (size_t i = 0; i < 3; ++i) {
    const Vec3& local = hit.deformed ? deformed[hit.triangle[i]] : (*hit.normals)[i];
    normals[i] = (scene.normal_matrix(hit.mesh_id) * local).normalized();
  }
  const SmoothPoint smooth = smooth_point({corner, corner + posed.edge_u, corner + posed.edge_v}, normals, hit.u, hit.v);
  posed.point = smooth.position;
  posed.normal = smooth.normal;
  posed.curvature = smooth.curvature;
}

void pose_triangle(const LocalHit& hit, const PosedScene& scene, PosedHit& posed) {
  pose_facet(hit, scene, posed);
  posed.is_smooth = hit.normals != nullptr;
  posed.facet = posed.point;
  if (posed.is_smooth) curve(hit, scene, posed);
}

// Most hits are on rigid facets and need only this.
void pose_point(const LocalHit& hit, const PosedScene& scene, PosedHit& posed) {
  posed.point = scene.linear(hit.mesh_id) * hit.point + scene.translation(hit.mesh_id);
  posed.normal = (scene.normal_matrix(hit.mesh_id) * hit.normal).normalized();
  posed.is_smooth = false;
  posed.area_ratio = 1.0;
}

}  // namespace

void pose_facet(const LocalHit& hit, const PosedScene& scene, PosedHit& out) {
  const Mat3& rotation = scene.linear(hit.mesh_id);
  Vec3 corner = hit.corner, edge_u = hit.edge_u, edge_v = hit.edge_v;
  if (hit.deformed) {
    const std::vector<Vec3>& vertices = scene.local_vertices(hit.mesh_id);
    corner = vertices[hit.triangle[0]];
    edge_u = vertices[hit.triangle[1]] - corner;
    edge_v = vertices[hit.triangle[2]] - corner;
  }
  out.edge_u = rotation * edge_u;
  out.edge_v = rotation * edge_v;
  out.point = rotation * corner + scene.translation(hit.mesh_id) + hit.u * out.edge_u + hit.v * out.edge_v;
  const Vec3 across = out.edge_u.cross(out.edge_v);
  out.normal = across.normalized();
  out.area_ratio = hit.trace_area > 0 ? across.norm() / hit.trace_area : 1.0;
}

void pose_hit(const LocalHit& hit, const PosedScene& scene, bool with_triangle, PosedHit& out) {
  out.is_edge = hit.edge != nullptr;
  if (with_triangle || hit.deformed || hit.normals || hit.trace_area > 0) pose_triangle(hit, scene, out);
  else pose_point(hit, scene, out);
  if (hit.edge) out.normal = outward_of(posed_wedge(*hit.edge, scene, hit.mesh_id));
}

void pose_hits(const LocalPath& path, const PosedScene& scene, PosedHit* out) {
  for (int k = 0; k < path.count; ++k) pose_hit(path.hits[k], scene, false, out[k]);
}

UnfoldedLeg unfolded_leg(const PosedHit* hits, const Vec3& from, int first, int last, const Vec3& to) {
  const std::span<const PosedHit> mirrors = chain_of(hits, first, last);
  const Vec3 line = to - image_over(mirrors, from);
  const double length = line.norm();
  const Vec3 arrival = line / length;
  return {length, mirrored_over_reversed(mirrors, arrival), arrival};
}

UnfoldedLeg inner_leg(const PosedHit* hits, int from, int to) {
  return unfolded_leg(hits, hits[from].point, from + 1, to, hits[to].point);
}

}  // namespace echopath
