#include "echopath/trace/mirrors/mirrors.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "echopath/scene/edges/planar_patches.h"
#include "echopath/trace/geometry/convex_hull.h"
#include "echopath/trace/mirrors/coplanar_mirrors.h"

namespace echopath {
namespace {

constexpr double kFilled = 1e-6;  // of the area
constexpr double kTeLimit = 0.70710678118654752;
constexpr double kNormalIncidence = 1e-12;  // sine of incidence
constexpr double kAlongTravel = 0.1;        // sine between field and direction of travel

// Fits a plane to some triangles of a mesh.
Mirror fit_plane(const Scene& scene, const EmbreeScene& geometry, uint32_t mesh_id, const std::vector<uint32_t>& triangles) {
  Mirror mirror;
  mirror.mesh_id = mesh_id;
  mirror.material = scene.node_of(mesh_id).material.get();
  mirror.point.setZero();
  Vec3 area_normal = Vec3::Zero(), reference = Vec3::Zero();
  std::vector<std::array<Vec3, 3>> all_corners;
  double weight = 0.0;
  for (const uint32_t triangle : triangles) {
    const auto& [a, b, c] = all_corners.emplace_back(geometry.corners(mesh_id, triangle));
    Vec3 cross = cross_of_sides(a, b, c);
    if (reference.isZero(0)) reference = cross;
    if (cross.dot(reference) < 0) cross = -cross;  // windings may differ
    area_normal += cross;
    mirror.point += cross.norm() * (a + b + c) / 3.0;
    weight += cross.norm();
  }
  mirror.point /= weight;
  mirror.normal = area_normal.normalized();
  mirror.mesh = PlaneMesh(mesh_id, triangles, all_corners, mirror.normal);
  return mirror;
}

// Returns whether the areas of all triangles, overlaps included, add up to that of the outline.
bool fills_outline(const EmbreeScene& geometry, const Mirror& mirror, const std::vector<uint32_t>& triangles) {
  double filled = 0.0, whole = 0.0;
  for (const uint32_t triangle : triangles) {
    const auto [a, b, c] = geometry.corners(mirror.mesh_id, triangle);
    filled += cross_of_sides(a, b, c).norm();
  }
  for (size_t i = 2; i < mirror.outline.size(); ++i) {
    whole += (mirror.outline[i - 1] - mirror.outline[0]).cross(mirror.outline[i] - mirror.outline[0]).norm();
  }
  return std::abs(filled - whole) <= kFilled * whole;
}

// Finds the planes of one flagged mesh.
class FaceFinder {
 public:
  FaceFinder(const Scene& scene, const EmbreeScene& geometry, uint32_t mesh_id)
      : scene_(scene), geometry_(geometry), mesh_id_(mesh_id), node_(scene.node_of(mesh_id)),
        all_(node_.mesh->triangles().size()) {
    std::iota(all_.begin(), all_.end(), 0u);
  }

  void append_to(std::vector<Mirror>& mirrors) const {
    Mirror whole = fit_plane(scene_, geometry_, mesh_id_, all_);
    double extent = 0.0;
    for (const Vec3& vertex : geometry_.vertices(mesh_id_)) extent = std::max(extent, (vertex - whole.point).norm());
    const double tolerance = flat_tolerance(extent), deviation = deviation_from(whole);
    if (deviation <= tolerance) return append(std::move(whole), all_, mirrors);
    require(!node_.smooth, "material.mirror",
            "the smooth mesh '" + node_.name + "' must be flat, since curved surfaces have no images; deviation in m",
            deviation);
    int face = 0;
    for (std::vector<uint32_t>& triangles :
         planar_patches(geometry_.vertices(mesh_id_), node_.mesh->triangles(), tolerance)) {
      Mirror mirror = fit_plane(scene_, geometry_, mesh_id_, triangles);
      mirror.face = face++;
      mirror.triangles = triangles;
      append(std::move(mirror), triangles, mirrors);
    }
  }

 private:
  double deviation_from(const Mirror& mirror) const {
    double deviation = 0.0;
    for (const Vec3& vertex : geometry_.vertices(mesh_id_)) deviation = std::max(deviation, std::abs(mirror.height(vertex)));
    return deviation;
  }

  void append(Mirror mirror, const std::vector<uint32_t>& triangles, std::vector<Mirror>& mirrors) const {
    std::vector<Vec3> corners;
    for (const uint32_t triangle : triangles) {
      for (const Vec3& corner : geometry_.corners(mesh_id_, triangle)) corners.push_back(corner);
    }
    mirror.outline = outline_of(mirror, mirror.face < 0 ? geometry_.vertices(mesh_id_) : corners);
    mirror.is_solid = fills_outline(geometry_, mirror, triangles);
    mirrors.push_back(std::move(mirror));
  }

  const Scene& scene_;
  const EmbreeScene& geometry_;
  uint32_t mesh_id_;
  const Node& node_;
  std::vector<uint32_t> all_;
};

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
    if (scene.node_of(mesh_id).material->mirror) FaceFinder(scene, geometry, mesh_id).append_to(mirrors);
  }
  find_coplanar(geometry, mirrors);
  return mirrors;
}

std::string name_of(const Mirror& mirror, const Scene& scene) {
  const std::string& name = scene.node_of(mirror.mesh_id).name;
  return mirror.face < 0 ? name : name + ", face " + std::to_string(mirror.face);
}

MirrorIndex::MirrorIndex(const std::vector<Mirror>& mirrors, const EmbreeScene& geometry) {
  for (size_t i = 0; i < mirrors.size(); ++i) {
    const Mirror& mirror = mirrors[i];
    const size_t mesh = mirror.mesh_id;
    of_mesh_.resize(std::max(of_mesh_.size(), mesh + 1), kNone);
    of_mesh_[mesh] = mirror.face < 0 ? static_cast<int>(i) : kFaces;
    if (mirror.face < 0) continue;
    of_triangle_.resize(of_mesh_.size());
    of_triangle_[mesh].resize(geometry.num_triangles(mirror.mesh_id), kNone);
    for (const uint32_t triangle : mirror.triangles) of_triangle_[mesh][triangle] = static_cast<int>(i);
  }
}

PolarizationMode polarization_mode(const Vec3& polarization, const Vec3& direction, const Vec3& normal) {
  const double along = polarization.dot(direction);
  // The part along the direction behind the bounce is written out, without `mirrored`: antennas on a slant lie at the 45
  // degrees where rounding decides.
  const double along_behind = along - 2.0 * direction.dot(normal) * polarization.dot(normal);
  const Vec3 te_axis = direction.cross(normal);
  const double te_squared = te_axis.squaredNorm();
  const double across_squared = polarization.squaredNorm() - 0.5 * (along * along + along_behind * along_behind);
  if (te_squared < kNormalIncidence * kNormalIncidence) return PolarizationMode::kTe;  // both are the same
  if (across_squared < kAlongTravel * kAlongTravel) return PolarizationMode::kTm;
  const double te = polarization.dot(te_axis);  // the axis lies across the direction
  return te * te >= kTeLimit * kTeLimit * te_squared * across_squared ? PolarizationMode::kTe : PolarizationMode::kTm;
}

double mirror_sign(PolarizationMode mode, const Vec3& polarization, const Vec3& direction, const Vec3& normal) {
  if (mode == PolarizationMode::kTe) return 1.0;
  const Vec3 te_axis = direction.cross(normal), behind = mirrored(direction, normal);
  return polarization.dot(te_axis.cross(direction)) * polarization.dot(te_axis.cross(behind)) < 0 ? -1.0 : 1.0;
}

SurfaceResponse respond_as_mirror(const SurfaceModel& model, const Vec3& polarization, const Vec3& direction,
                                  const Vec3& normal) {
  const PolarizationMode mode = mode_along(model, polarization, direction, normal);
  SurfaceResponse response = model.respond(std::abs(direction.dot(normal)), mode);
  response.gamma *= mirror_sign(mode, polarization, direction, normal);
  return response;
}

}  // namespace echopath
