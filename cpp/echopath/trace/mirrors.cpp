#include "echopath/trace/mirrors.h"

#include <algorithm>
#include <cmath>

namespace echopath {
namespace {

constexpr double kFlatAbsolute = 1e-4;   // m
constexpr double kFlatRelative = 1e-6;   // of the mesh's extent
constexpr double kOnPlane = 1e-4;        // m: a point this near the plane has no image leg over it
constexpr double kTeLimit = 0.70710678118654752;
constexpr double kAlongTravel = 0.1;  // sine between field and direction of travel

Mirror fit_plane(const Scene& scene, const EmbreeScene& geometry, uint32_t mesh_id) {
  const std::vector<Triangle>& triangles = scene.node_of(mesh_id).mesh->triangles();
  Mirror mirror;
  mirror.mesh_id = mesh_id;
  mirror.material = scene.node_of(mesh_id).material.get();
  mirror.point.setZero();
  Vec3 area_normal = Vec3::Zero(), reference = Vec3::Zero();
  double weight = 0.0;
  for (uint32_t i = 0; i < triangles.size(); ++i) {
    const auto [a, b, c] = geometry.corners(mesh_id, i);
    Vec3 cross = (b - a).cross(c - a);
    if (i == 0) reference = cross;
    if (cross.dot(reference) < 0) cross = -cross;  // windings may differ
    area_normal += cross;
    mirror.point += cross.norm() * (a + b + c) / 3.0;
    weight += cross.norm();
  }
  mirror.point /= weight;
  mirror.normal = area_normal.normalized();
  return mirror;
}

void require_flat(const Scene& scene, const EmbreeScene& geometry, const Mirror& mirror) {
  double deviation = 0.0, extent = 0.0;
  for (const Vec3& vertex : geometry.vertices(mirror.mesh_id)) {
    deviation = std::max(deviation, std::abs(mirror.signed_distance(vertex)));
    extent = std::max(extent, (vertex - mirror.point).norm());
  }
  require(deviation <= kFlatAbsolute + kFlatRelative * extent, "material.mirror",
          "the mesh '" + scene.node_of(mirror.mesh_id).name + "' must be flat, deviation in m", deviation);
}

}  // namespace

std::vector<Mirror> find_mirrors(const Scene& scene, const EmbreeScene& geometry) {
  std::vector<Mirror> mirrors;
  for (uint32_t mesh_id = 0; mesh_id < scene.meshes().size(); ++mesh_id) {
    if (!scene.node_of(mesh_id).material->mirror) continue;
    mirrors.push_back(fit_plane(scene, geometry, mesh_id));
    require_flat(scene, geometry, mirrors.back());
  }
  return mirrors;
}

PolarizationMode polarization_mode(const Vec3& polarization, const Vec3& direction, const Vec3& normal) {
  const Vec3 across = polarization - polarization.dot(direction) * direction;
  const Vec3 te_axis = direction.cross(normal);
  const double scale = across.norm() * te_axis.norm();
  if (te_axis.norm() < 1e-12) return PolarizationMode::kTe;  // normal incidence: both are the same
  if (across.norm() < kAlongTravel) return PolarizationMode::kTm;
  return std::abs(across.dot(te_axis)) >= kTeLimit * scale ? PolarizationMode::kTe : PolarizationMode::kTm;
}

void LegFinder::find(const Vec3& point, const Vec3& normal, const Vec3& antenna, bool with_mirrors, int skip,
                     std::vector<Leg>& legs, int64_t& num_queries) const {
  legs.clear();
  const Vec3 line = antenna - point;
  if (skip != -1 && normal.dot(line) > 0) {
    ++num_queries;
    if (!geometry_.occluded(geometry_.lifted(point, normal), antenna)) {
      Leg& leg = legs.emplace_back();
      leg.length = line.norm();
      leg.to_antenna = line / leg.length;
      leg.at_antenna = -leg.to_antenna;
    }
  }
  if (!with_mirrors) return;
  for (int mirror = 0; mirror < static_cast<int>(mirrors_.size()); ++mirror) {
    if (mirror == skip) continue;
    Leg leg;
    if (over_mirror(mirror, point, normal, antenna, leg, num_queries)) legs.push_back(leg);
  }
}

bool LegFinder::over_mirror(int index, const Vec3& point, const Vec3& normal, const Vec3& antenna, Leg& leg,
                            int64_t& num_queries) const {
  const Mirror& mirror = mirrors_[static_cast<size_t>(index)];
  const double side = mirror.signed_distance(point), antenna_side = mirror.signed_distance(antenna);
  if (std::abs(side) < kOnPlane || side * antenna_side <= 0) return false;
  const Vec3 line = mirror.image(antenna) - point;
  if (normal.dot(line) <= 0) return false;
  leg.mirror = index;
  leg.length = line.norm();
  leg.to_antenna = line / leg.length;
  leg.at_antenna = -mirror.reflect(leg.to_antenna);

  // One closest-hit query answers both whether the mirror is there and whether the way to it is free.
  RayHit met;
  ++num_queries;
  if (geometry_.intersect(geometry_.lifted(point, normal), leg.to_antenna, met) != EmbreeScene::Verdict::kHit) return false;
  if (met.hit.mesh_id != mirror.mesh_id) return false;
  leg.mirror_hit = met.hit;
  const Vec3 lit_normal = side > 0 ? mirror.normal : Vec3(-mirror.normal);
  ++num_queries;
  if (geometry_.occluded(geometry_.lifted(met.position, lit_normal), antenna)) return false;

  leg.mirror_normal = lit_normal;
  const double cos_incidence = std::abs(leg.to_antenna.dot(mirror.normal));
  const PolarizationMode mode = polarization_mode(polarization_, leg.to_antenna, mirror.normal);
  const SurfaceResponse response = respond(*mirror.material, frequency_, cos_incidence, mode);
  leg.gain = response.gamma * response.coherent;
  leg.specular_share = response.coherent * response.coherent;
  return std::abs(leg.gain) > 0;
}

}  // namespace echopath
