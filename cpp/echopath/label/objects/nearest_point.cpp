#include "echopath/label/objects/nearest_point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace echopath {
namespace {

constexpr double kRounding = 1e-9;  // relative to a length, more than that of posed vertices

double distance_to_triangle(const Vec3& point, const std::array<Vec3, 3>& corners) {
  const auto& [a, b, c] = corners;
  const Vec3 normal = cross_of_sides(a, b, c).normalized();
  bool is_above = true;  // the foot of the perpendicular lies on the inner side of all three edges
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
    is_above = is_above && normal.cross(to - from).dot(point - from) >= 0.0;
    least = std::min(least, distance_to_segment(point, from, to));
  }
  return is_above ? std::abs(normal.dot(point - a)) : least;
}

// Returns whether a point is nearer than `least` (m) to the box about a triangle, which most triangles need not be asked
// more about.
bool is_box_nearer(const Vec3& point, const std::array<Vec3, 3>& corners, double least) {
  const auto& [a, b, c] = corners;
  const Vec3 below = a.cwiseMin(b).cwiseMin(c) - point, above = point - a.cwiseMax(b).cwiseMax(c);
  return below.cwiseMax(above).cwiseMax(0.0).squaredNorm() < least * least;
}

// Returns a factor by which a map lengthens nothing more: a bound of its largest singular value, which a rotation meets.
double largest_stretch(const Mat3& linear) {
  return std::sqrt((linear.transpose() * linear).cwiseAbs().rowwise().sum().maxCoeff());
}

// Looks for the nearest point of a mesh run by run, by the boxes in the frame of the mesh, or of a deformed one by those in
// the geometry.
class RunsOfMesh {
 public:
  RunsOfMesh(const Node& node, const PosedScene& pose, const EmbreeScene& geometry, uint32_t mesh)
      : geometry_(geometry), mesh_(mesh), num_triangles_(static_cast<uint32_t>(node.mesh->triangles().size())) {
    if (node.deformation) {
      own_boxes_ = find_boxes_of_runs(geometry.vertices(mesh), node.mesh->triangles());
      return;
    }
    boxes_ = &node.mesh->boxes_of_runs();
    to_mesh_ = pose.linear(mesh).inverse();
    place_ = pose.world_translation(mesh) - geometry.origin();
    shortest_ = 1.0 / largest_stretch(to_mesh_);
    longest_ = largest_stretch(pose.linear(mesh));
  }

  RunsOfMesh(const RunsOfMesh&) = delete;
  RunsOfMesh& operator=(const RunsOfMesh&) = delete;

  // Returns the distance in m of the mesh from a point if it is less than `limit`, else that. A run that is nowhere nearer
  // than the farthest corner of another one is not looked at, nor one that is nowhere nearer than what was found in those
  // that begin before it.
  double distance_below(double limit, const Vec3& point) const {
    double least = limit;
    for (const auto& [begin, run] : nearest_runs(limit, to_mesh_ * (point - place_))) {
      if (begin >= least) break;
      const uint32_t end = std::min((run + 1) * kRunLength, num_triangles_);
      for (uint32_t i = run * kRunLength; i < end; ++i) {
        const std::array<Vec3, 3> corners = geometry_.corners(mesh_, i);
        if (is_box_nearer(point, corners, least)) least = std::min(least, distance_to_triangle(point, corners));
      }
    }
    return least;
  }

 private:
  // Returns the runs that may be nearer than `limit`, and how far away they begin at least, m, in this order.
  std::vector<std::pair<double, uint32_t>> nearest_runs(double limit, const Vec3& point) const {
    std::vector<std::pair<double, uint32_t>> runs;
    double nearest_end = limit;
    for (uint32_t run = 0; run < boxes_->size(); ++run) {
      const Box& box = (*boxes_)[run];
      const double begin = box.exteriorDistance(point) * shortest_ * (1.0 - kRounding);
      if (begin >= nearest_end) continue;
      const Vec3 farthest = (point - box.min()).cwiseAbs().cwiseMax((point - box.max()).cwiseAbs());
      nearest_end = std::min(nearest_end, farthest.norm() * longest_ * (1.0 + kRounding));
      runs.emplace_back(begin, run);
    }
    std::erase_if(runs, [&](const auto& run) { return run.first > nearest_end; });
    std::ranges::sort(runs);
    return runs;
  }

  const EmbreeScene& geometry_;
  uint32_t mesh_, num_triangles_;
  std::vector<Box> own_boxes_;  // of a deformed mesh
  const std::vector<Box>* boxes_ = &own_boxes_;
  Mat3 to_mesh_ = Mat3::Identity();        // takes lines of the geometry to those of the boxes
  Vec3 place_ = Vec3::Zero();              // m, of the origin of the boxes in the geometry
  double shortest_ = 1.0, longest_ = 1.0;  // lengths in the geometry of what is 1 m long among the boxes
};

}  // namespace

NearestPoints::NearestPoints(const Scene& scene, const PosedScene& pose, const EmbreeScene& geometry)
    : scene_(scene), geometry_(geometry), pose_(pose) {}

std::array<double, 2> NearestPoints::distances(const Points& points, std::span<const uint32_t> mesh_ids) const {
  std::vector<std::pair<double, uint32_t>> by_box;
  for (const uint32_t id : mesh_ids) by_box.emplace_back(geometry_.box(id).exteriorDistance(points[0]), id);
  std::ranges::sort(by_box);
  std::array<double, 2> least;
  least.fill(std::numeric_limits<double>::infinity());
  const double apart = (points[1] - points[0]).norm();
  for (const auto& [distance, id] : by_box) {
    if (distance >= std::max(least[0], least[1] + apart)) break;
    const RunsOfMesh runs(scene_.node_of(id), pose_, geometry_, id);
    for (size_t k = 0; k < points.size(); ++k) least[k] = runs.distance_below(least[k], points[k]);
  }
  return least;
}

}  // namespace echopath
