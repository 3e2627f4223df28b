#include "echopath/label/objects/visibility.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "echopath/base/errors.h"
#include "echopath/base/parallel.h"
#include "echopath/trace/geometry/embree_scene.h"
#include "echopath/trace/launch/fit_stratum.h"
#include "echopath/trace/launch/launch_directions.h"
#include "echopath/trace/launch/sampler.h"
#include "echopath/trace/launch/scene_objects.h"

namespace echopath {
namespace {

constexpr int64_t kDirectionsPerTask = 1024;
// Surfaces this near behind each other, relative to the distance, are one: a label on a box does not hide it.
constexpr double kSameDepth = 1e-5;

// Holds the antennas of one end of the radar.
struct End {
  Vec3 position;  // mean, relative to the origin
  std::vector<PosedAntenna> antennas;

  bool has_gain_toward(const Vec3& direction) const {
    return std::any_of(antennas.begin(), antennas.end(),
                       [&](const PosedAntenna& antenna) { return antenna.toward(direction).power > 0.0; });
  }
};

double distance_to_triangle(const Vec3& point, const std::array<Vec3, 3>& corners) {
  const auto& [a, b, c] = corners;
  const Vec3 normal = (b - a).cross(c - a).normalized();
  bool is_above = true;  // the foot of the perpendicular lies on the inner side of all three edges
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
    is_above = is_above && normal.cross(to - from).dot(point - from) >= 0.0;
    least = std::min(least, distance_to_segment(point, from, to));
  }
  return is_above ? std::abs(normal.dot(point - a)) : least;
}

// Returns the scene with the nodes in their places but only the meshes of one object.
Scene scene_with_object(const Scene& scene, const SurfaceMap& surfaces, uint32_t object) {
  std::vector<bool> is_kept(scene.nodes().size());
  for (const uint32_t mesh : surfaces.meshes_of(object)) is_kept[static_cast<size_t>(scene.meshes()[mesh].node)] = true;
  Scene part;
  for (size_t i = 0; i < scene.nodes().size(); ++i) {
    Node node = scene.nodes()[i];
    node.name = node.name.substr(node.name.rfind('/') + 1);
    if (!is_kept[i]) {
      node.mesh.reset();
      node.material.reset();
      node.deformation.reset();
    }
    part.add(std::move(node));
  }
  return part;
}

// Counts what some directions found.
struct Tally {
  int64_t num_found = 0, num_visible = 0;
  std::vector<int64_t> hidden_by;  // by surface
  bool in_view = false;

  explicit Tally(size_t num_surfaces = 0) : hidden_by(num_surfaces) {}
  void add(const Tally& other) {
    num_found += other.num_found;
    num_visible += other.num_visible;
    for (size_t i = 0; i < hidden_by.size(); ++i) hidden_by[i] += other.hidden_by[i];
    in_view = in_view || other.in_view;
  }
};

// Finds what hides one object in its scene.
class ObjectScanner {
 public:
  ObjectScanner(const Scene& scene, const EmbreeScene& whole, const EmbreeScene& alone, const SurfaceMap& surfaces,
                uint32_t object)
      : scene_(scene), whole_(whole), alone_(alone), surfaces_(surfaces), object_(object),
        mesh_ids_(surfaces.meshes_of(object)) {}

  Sight sight_from(const End& end, int num_directions, Job* job) const {
    const Stratum stratum = stratum_from(end.position);
    int64_t count = num_directions;
    Tally tally = scan(end, stratum, count, job);
    if (2 * tally.num_found < num_directions) {
      count = std::min<int64_t>(kFinestLattice, num_directions / std::max<int64_t>(1, tally.num_found)) * num_directions;
      tally = scan(end, stratum, count, job);
    }
    return sight_of(tally, stratum.solid_angle() / static_cast<double>(count), end);
  }

 private:
  // Returns the cone of directions that holds the object, or all directions where it surrounds the antenna.
  Stratum stratum_from(const Vec3& apex) const {
    std::vector<Vec3> vertices;
    for (const uint32_t id : mesh_ids_)
      vertices.insert(vertices.end(), whole_.vertices(id).begin(), whole_.vertices(id).end());
    return fit_stratum(vertices, apex, surfaces_.names[object_]).value_or(Stratum{});
  }

  Tally scan(const End& end, const Stratum& stratum, int64_t count, Job* job) const {
    const LaunchDirections directions({stratum});
    const auto points = launch_points(Sampler::kLattice, domain_of(stratum), count, {Eigen::Vector2d(0.5, 0.5)});
    const int64_t num_tasks = (count + kDirectionsPerTask - 1) / kDirectionsPerTask;
    std::vector<Tally> tallies(static_cast<size_t>(num_tasks), Tally(surfaces_.names.size()));
    parallel_for(num_tasks, [&](int64_t task) {
      if (job) job->throw_if_cancelled();
      const int64_t last = std::min(count, (task + 1) * kDirectionsPerTask);
      for (int64_t i = task * kDirectionsPerTask; i < last; ++i) {
        add_direction(directions.direction(0, points->point(i)), end, tallies[static_cast<size_t>(task)]);
      }
    });
    Tally sum(surfaces_.names.size());
    for (const Tally& tally : tallies) sum.add(tally);
    return sum;
  }

  void add_direction(const Vec3& direction, const End& end, Tally& tally) const {
    RayHit object, nearest;
    if (alone_.intersect(end.position, direction, object) != EmbreeScene::Verdict::kHit) return;
    const EmbreeScene::Verdict verdict = whole_.intersect(end.position, direction, nearest);
    if (verdict == EmbreeScene::Verdict::kFalseHit) return;
    ++tally.num_found;
    tally.in_view = tally.in_view || end.has_gain_toward(direction);
    const uint32_t surface = verdict == EmbreeScene::Verdict::kHit ? surfaces_.of_mesh[nearest.hit.mesh_id] : object_;
    if (surface == object_ || nearest.distance >= object.distance * (1.0 - kSameDepth)) ++tally.num_visible;
    else ++tally.hidden_by[surface];
  }

  Sight sight_of(const Tally& tally, double solid_angle_each, const End& end) const {
    Sight sight;
    sight.in_view = tally.num_found > 0 ? tally.in_view : has_gain_toward_a_vertex(end);
    sight.distance = distance_from(end.position);
    if (tally.num_found == 0) return sight;
    const auto found = static_cast<double>(tally.num_found);
    sight.solid_angle = found * solid_angle_each;
    sight.visible_share = static_cast<double>(tally.num_visible) / found;
    for (size_t i = 0; i < tally.hidden_by.size(); ++i) {
      const auto hidden = static_cast<double>(tally.hidden_by[i]);
      if (hidden > 0) sight.occluders.emplace_back(surfaces_.names[i], hidden / found);
    }
    std::stable_sort(sight.occluders.begin(), sight.occluders.end(),
                     [](const auto& a, const auto& b) { return a.second > b.second; });
    return sight;
  }

  bool has_gain_toward_a_vertex(const End& end) const {
    return std::any_of(mesh_ids_.begin(), mesh_ids_.end(), [&](uint32_t mesh) {
      const std::vector<Vec3>& vertices = whole_.vertices(mesh);
      return std::any_of(vertices.begin(), vertices.end(), [&](const Vec3& vertex) {
        return vertex != end.position && end.has_gain_toward((vertex - end.position).normalized());
      });
    });
  }

  double distance_from(const Vec3& point) const {
    double least = std::numeric_limits<double>::infinity();
    for (const uint32_t mesh : mesh_ids_) {
      const auto num_triangles = static_cast<uint32_t>(scene_.node_of(mesh).mesh->triangles().size());
      for (uint32_t i = 0; i < num_triangles; ++i) {
        least = std::min(least, distance_to_triangle(point, whole_.corners(mesh, i)));
      }
    }
    return least;
  }

  const Scene& scene_;
  const EmbreeScene& whole_;
  const EmbreeScene& alone_;
  const SurfaceMap& surfaces_;
  uint32_t object_;
  std::vector<uint32_t> mesh_ids_;
};

}  // namespace

std::vector<ObjectVisibility> visibility(const Scene& scene, const Radar& radar, const SurfaceMap& surfaces,
                                         const VisibilitySettings& settings, Job* job) {
  radar.validate();
  require(settings.num_directions >= 1, "num_directions", "must be at least 1", settings.num_directions);
  const size_t num_meshes = surfaces.of_mesh.size();
  require(num_meshes == scene.meshes().size(), "surfaces", "must be of the scene, meshes", num_meshes);
  scene.require_times(settings.time, settings.time);
  const Transform world_from_radar = radar.world_from_radar(settings.time);
  const Vec3 transmitter = mean_position(radar.transmitters, world_from_radar);
  const Vec3 receiver = mean_position(radar.receivers, world_from_radar);
  const PosedScene pose(scene, settings.time);
  const Vec3 origin = EmbreeScene::origin_near(scene, pose, transmitter);
  const EmbreeScene whole(scene, pose, origin, job);
  const End sending{transmitter - origin, posed_antennas(radar.transmitters, world_from_radar, origin)};
  const End receiving{receiver - origin, posed_antennas(radar.receivers, world_from_radar, origin)};

  std::vector<ObjectVisibility> seen;
  if (job) job->start(surfaces.num_objects);
  for (uint32_t object = 0; object < surfaces.num_objects; ++object) {
    const Scene part = scene_with_object(scene, surfaces, object);
    const EmbreeScene alone(part, PosedScene(part, settings.time), origin, job);
    const ObjectScanner scanner(scene, whole, alone, surfaces, object);
    seen.push_back({surfaces.names[object], scanner.sight_from(sending, settings.num_directions, job),
                    scanner.sight_from(receiving, settings.num_directions, job)});
    if (job) job->advance(1);
  }
  return seen;
}

}  // namespace echopath
