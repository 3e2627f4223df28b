#include "echopath/trace/mirrors/mirrors.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "echopath/trace/geometry/convex_hull.h"

namespace echopath {
namespace {

constexpr double kFlatAbsolute = 1e-4;  // m
constexpr double kFlatRelative = 1e-6;  // of the mesh's extent
constexpr double kFilled = 1e-6;        // of the area
constexpr double kTeLimit = 0.70710678118654752;
constexpr double kNormalIncidence = 1e-12;  // sine of incidence
constexpr double kAlongTravel = 0.1;        // sine between field and direction of travel

Mirror fit_plane(const Scene& scene, const EmbreeScene& geometry, uint32_t mesh_id) {
  const std::vector<Triangle>& triangles = scene.node_of(mesh_id).mesh->triangles();
  Mirror mirror;
  mirror.mesh_id = mesh_id;
  mirror.material = scene.node_of(mesh_id).material.get();
  mirror.point.setZero();
  Vec3 area_normal = Vec3::Zero(), reference = Vec3::Zero();
  std::vector<std::array<Vec3, 3>> all_corners;
  double weight = 0.0;
  for (uint32_t i = 0; i < triangles.size(); ++i) {
    const auto& [a, b, c] = all_corners.emplace_back(geometry.corners(mesh_id, i));
    Vec3 cross = (b - a).cross(c - a);
    if (i == 0) reference = cross;
    if (cross.dot(reference) < 0) cross = -cross;  // windings may differ
    area_normal += cross;
    mirror.point += cross.norm() * (a + b + c) / 3.0;
    weight += cross.norm();
  }
  mirror.point /= weight;
  mirror.normal = area_normal.normalized();
  mirror.mesh = PlaneMesh(mesh_id, all_corners, mirror.normal);
  return mirror;
}

void require_flat(const Scene& scene, const EmbreeScene& geometry, const Mirror& mirror) {
  double deviation = 0.0, extent = 0.0;
  for (const Vec3& vertex : geometry.vertices(mirror.mesh_id)) {
    deviation = std::max(deviation, std::abs(mirror.height(vertex)));
    extent = std::max(extent, (vertex - mirror.point).norm());
  }
  require(deviation <= kFlatAbsolute + kFlatRelative * extent, "material.mirror",
          "the mesh '" + scene.node_of(mirror.mesh_id).name + "' must be flat, deviation in m", deviation);
}

// Returns whether the areas of all triangles, overlaps included, add up to that of the outline.
bool fills_outline(const Scene& scene, const EmbreeScene& geometry, const Mirror& mirror) {
  double filled = 0.0, whole = 0.0;
  const auto num_triangles = static_cast<uint32_t>(scene.node_of(mirror.mesh_id).mesh->triangles().size());
  for (uint32_t i = 0; i < num_triangles; ++i) {
    const auto [a, b, c] = geometry.corners(mirror.mesh_id, i);
    filled += (b - a).cross(c - a).norm();
  }
  for (size_t i = 2; i < mirror.outline.size(); ++i) {
    whole += (mirror.outline[i - 1] - mirror.outline[0]).cross(mirror.outline[i] - mirror.outline[0]).norm();
  }
  return std::abs(filled - whole) <= kFilled * whole;
}

}  // namespace

std::vector<Vec3> outline_of(const Mirror& mirror, const std::vector<Vec3>& corners) {
  const Vec3 first = mirror.normal.unitOrthogonal(), second = mirror.normal.cross(first);
  PlanePoints points;
  for (const Vec3& corner : corners)
    points.emplace_back(first.dot(corner - mirror.point), second.dot(corner - mirror.point));
  std::vector<Vec3> outline;
  for (const Eigen::Vector2d& corner : convex_hull(std::move(points))) {
    outline.push_back(mirror.point + corner[0] * first + corner[1] * second);
  }
  return outline;
}

std::vector<Mirror> find_mirrors(const Scene& scene, const EmbreeScene& geometry) {
  std::vector<Mirror> mirrors;
  for (uint32_t mesh_id = 0; mesh_id < scene.meshes().size(); ++mesh_id) {
    if (!scene.node_of(mesh_id).material->mirror) continue;
    mirrors.push_back(fit_plane(scene, geometry, mesh_id));
    require_flat(scene, geometry, mirrors.back());
    mirrors.back().outline = outline_of(mirrors.back(), geometry.vertices(mesh_id));
    mirrors.back().is_solid = fills_outline(scene, geometry, mirrors.back());
  }
  return mirrors;
}

PolarizationMode polarization_mode(const Vec3& polarization, const Vec3& direction, const Vec3& normal) {
  const double along = polarization.dot(direction);
  const double along_behind = along - 2.0 * direction.dot(normal) * polarization.dot(normal);  // after the bounce
  const Vec3 te_axis = direction.cross(normal);
  const double te_squared = te_axis.squaredNorm();
  const double across_squared = polarization.squaredNorm() - 0.5 * (along * along + along_behind * along_behind);
  if (te_squared < kNormalIncidence * kNormalIncidence) return PolarizationMode::kTe;  // both are the same
  if (across_squared < kAlongTravel * kAlongTravel) return PolarizationMode::kTm;
  const double te = polarization.dot(te_axis);  // the axis lies across the direction
  return te * te >= kTeLimit * kTeLimit * te_squared * across_squared ? PolarizationMode::kTe : PolarizationMode::kTm;
}

double mirror_sign(const Material& material, PolarizationMode mode, const Vec3& polarization, const Vec3& direction,
                   const Vec3& normal) {
  if (mode == PolarizationMode::kTe || !material.permittivity) return 1.0;
  const Vec3 te_axis = direction.cross(normal), behind = mirrored(direction, normal);
  return polarization.dot(te_axis.cross(direction)) * polarization.dot(te_axis.cross(behind)) < 0 ? -1.0 : 1.0;
}

}  // namespace echopath
