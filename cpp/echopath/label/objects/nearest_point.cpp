#include "echopath/label/objects/nearest_point.h"

#include <algorithm>
#include <limits>

#include "echopath/scene/runs/nearest_of_runs.h"

namespace echopath {
namespace {

// Looks for the nearest point of a mesh by the boxes in its own frame, or of a deformed one by those in the geometry.
class RunsOfMesh {
 public:
  RunsOfMesh(const Node& node, const PosedScene& pose, const EmbreeScene& geometry, uint32_t mesh)
      : geometry_(geometry), mesh_(mesh),
        own_boxes_(node.deformation ? find_boxes_of_runs(geometry.vertices(mesh), node.mesh->triangles())
                                    : std::vector<Box>{}),
        runs_(node.deformation ? own_boxes_ : node.mesh->boxes_of_runs(), node.mesh->triangles().size(),
              node.deformation ? FrameOfBoxes{}
                               : FrameOfBoxes::mapped(pose.linear(mesh), pose.world_translation(mesh) - geometry.origin())) {
  }

  RunsOfMesh(const RunsOfMesh&) = delete;
  RunsOfMesh& operator=(const RunsOfMesh&) = delete;

  // Returns the distance in m of the mesh from a point if it is less than `limit`, else that.
  double distance_below(double limit, const Vec3& point) const {
    const std::optional<Vec3> nearest =
        runs_.within(limit, point, [&](uint32_t triangle) { return geometry_.corners(mesh_, triangle); });
    return nearest ? (*nearest - point).norm() : limit;
  }

 private:
  const EmbreeScene& geometry_;
  uint32_t mesh_;
  std::vector<Box> own_boxes_;  // of a deformed mesh
  NearestOfRuns runs_;
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
