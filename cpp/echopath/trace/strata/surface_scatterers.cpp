#include "echopath/trace/strata/surface_scatterers.h"

#include <algorithm>

#include "echopath/base/threads/parallel.h"
#include "echopath/em/surface/surface_response.h"

namespace echopath {
namespace {

constexpr int64_t kTrianglesTogether = 4096;

struct TriangleRange {
  uint32_t mesh_id;
  uint32_t number;  // SceneMesh::number
  int64_t begin, end;
  double outward;  // sign of the side of its triangles that can be seen; 0: both
};

bool is_rough(const Material& material, double frequency) {
  return SurfaceModel(material, frequency).respond(1.0, PolarizationMode::kTe).diffuse > 0.0;
}

double signed_volume(const EmbreeScene& geometry, uint32_t mesh_id) {
  double volume = 0.0;
  for (size_t i = 0; i < geometry.num_triangles(mesh_id); ++i) {
    const auto corners = geometry.corners(mesh_id, static_cast<uint32_t>(i));
    volume += corners[0].dot(corners[1].cross(corners[2]));
  }
  return volume;
}

// A closed body shows the outer side of its triangles to a viewer outside of its box.
double visible_side(const Mesh& mesh, const EmbreeScene& geometry, uint32_t mesh_id, const Vec3& viewer) {
  if (!mesh.is_closed() || geometry.box(mesh_id).contains(viewer)) return 0.0;
  return signed_volume(geometry, mesh_id) < 0.0 ? -1.0 : 1.0;
}

std::vector<TriangleRange> ranges_of(const Scene& scene, const EmbreeScene& geometry,
                                     const SurfaceScattererSettings& settings) {
  std::vector<TriangleRange> ranges;
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) {
    const Node& node = scene.node_of(id);
    if (!is_rough(*node.material, settings.frequency)) continue;
    const double outward = visible_side(*node.mesh, geometry, id, settings.transmitter);
    const auto count = static_cast<int64_t>(geometry.num_triangles(id));
    for (int64_t begin = 0; begin < count; begin += kTrianglesTogether) {
      ranges.push_back({id, scene.meshes()[id].number, begin, std::min(begin + kTrianglesTogether, count), outward});
    }
  }
  return ranges;
}

class PointFinder {
 public:
  PointFinder(const EmbreeScene& geometry, const LaunchPlan& plan, const SurfaceScattererSettings& settings)
      : geometry_(geometry), plan_(plan), settings_(settings) {}

  std::vector<SurfacePoint> find(const TriangleRange& range) const {
    const int stratum = plan_.owners.owner(range.mesh_id, kNoMirrors);
    const Stratum& directions = plan_.strata[plan_.foci.owner(stratum)];
    const PointDensity density{settings_.transmitter, plan_.default_density[stratum]};
    std::vector<SurfacePoint> points;
    for (int64_t i = range.begin; i < range.end; ++i) {
      const auto triangle = static_cast<uint32_t>(i);
      const auto corners = geometry_.corners(range.mesh_id, triangle);
      if (range.outward * side_of(corners) >= 0.0) {
        add_surface_points(settings_.seed, {{range.mesh_id, triangle}, range.number, corners}, density, points);
      }
    }
    std::erase_if(points, [&](SurfacePoint& point) {
      point.stratum = stratum;
      return !directions.contains((point.position - settings_.transmitter).normalized());
    });
    return points;
  }

 private:
  // Returns a number with the sign of the side from which the transmitter sees a triangle.
  double side_of(const std::array<Vec3, 3>& corners) const {
    return cross_of_sides(corners).dot(settings_.transmitter - corners[0]);
  }

  const EmbreeScene& geometry_;
  const LaunchPlan& plan_;
  const SurfaceScattererSettings& settings_;
};

}  // namespace

std::vector<SurfacePoint> find_surface_scatterers(const Scene& scene, const EmbreeScene& geometry, const LaunchPlan& plan,
                                                  const SurfaceScattererSettings& settings, Job* job) {
  const std::vector<TriangleRange> ranges = ranges_of(scene, geometry, settings);
  const PointFinder finder(geometry, plan, settings);
  std::vector<std::vector<SurfacePoint>> of_range(ranges.size());
  Job own(job);  // its progress is no part of that of the rays
  parallel_for(std::ssize(ranges), [&](int64_t i) { of_range[i] = finder.find(ranges[i]); }, &own);
  std::vector<SurfacePoint> points;
  for (const auto& found : of_range) points.insert(points.end(), found.begin(), found.end());
  return points;
}

}  // namespace echopath
