#include "echopath/sim/rays/find_glints.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <span>
#include <tuple>

#include "echopath/base/constants.h"
#include "echopath/base/plane.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/replay/replay.h"
#include "echopath/scene/smooth/reflection_point.h"
#include "echopath/sim/rays/chain_glints.h"
#include "echopath/trace/record/hit_points.h"

namespace echopath {
namespace {

constexpr double kBeside = 1.5;     // cells: a point of reflection is seen where a path lies this near
constexpr double kSamePoint = 0.5;  // of the narrower Fresnel zone

// Names the mesh of a flagged mirror and, where the mesh is no plane, the triangle that was hit.
using MirrorFace = std::pair<uint32_t, uint32_t>;
constexpr uint32_t kWholeMesh = 0xFFFFFFFFu;

// Identifies paths of one stratum that run over the same flagged mirrors to the same mesh and on.
struct RouteKind {
  uint16_t stratum;
  uint32_t mesh;
  std::vector<MirrorFace> before, behind;  // from antenna to antenna

  bool operator<(const RouteKind& other) const {
    return std::tie(stratum, mesh, before, behind) < std::tie(other.stratum, other.mesh, other.before, other.behind);
  }
};

// Holds a path of a kind and its direction of launch.
struct SeenPath {
  Vec3 direction;
  int64_t path;
  double amplitude = 0.0;
};

class GlintSearch {
 public:
  GlintSearch(const Paths& paths, Job* job) : paths_(paths), pose_(*paths.scene, paths.frame.trace_time) {
    sort_paths(job);
    weigh_paths(job);
  }

  std::vector<Glint> find(Job* job) const {
    std::vector<Route> routes;
    std::map<uint32_t, std::vector<size_t>> of_mesh;  // indices of routes
    for (const auto& [kind, seen] : kinds_) {
      of_mesh[kind.mesh].push_back(routes.size());
      routes.push_back(route_of(kind, seen));
    }
    Job unseen(job);
    const std::vector<MeshRoutes> meshes = posed(of_mesh, unseen);
    const std::vector<Task> tasks = tasks_of(meshes);
    std::vector<std::vector<FoundGlint>> found(tasks.size());
    parallel_for(std::ssize(tasks), [&](int64_t i) {
      const auto task = static_cast<size_t>(i);
      found[task] = glints_of(tasks[task], routes);
    }, &unseen);
    std::vector<std::vector<Glint>> of_route(routes.size());
    for (const std::vector<FoundGlint>& some : found) {
      for (const FoundGlint& one : some) of_route[one.route].push_back(one.glint);
    }
    std::vector<Glint> glints;
    for (const std::vector<Glint>& some : of_route) glints.insert(glints.end(), some.begin(), some.end());
    return glints;
  }

 private:
  using Kinds = std::map<RouteKind, std::vector<SeenPath>>;

  // Holds the planes of the mirrors before the mesh of a kind, and both antennas as that mesh sees them.
  struct Route {
    const std::vector<SeenPath>& seen;
    uint16_t stratum;
    std::vector<Plane> before;
    Vec3 first, second;
  };

  // Holds a mesh in the world and the indices of the routes over it.
  struct MeshRoutes {
    uint32_t mesh;
    std::vector<size_t> routes;
    std::vector<Vec3> vertices, normals;
  };

  // Names some triangles of a mesh.
  struct Task {
    const MeshRoutes& of;
    std::span<const Triangle> triangles;
  };

  struct FoundGlint {
    size_t route;
    Glint glint;
  };

  void sort_paths(Job* job) {
    constexpr int64_t kTogether = 1 << 16;
    for (int64_t path = 0; path < paths_.num_paths(); ++path) {
      if (job && path % kTogether == 0) job->throw_if_cancelled();
      std::optional<RouteKind> kind = kind_of(path);
      if (kind) kinds_[std::move(*kind)].push_back({direction_of_launch(path), path});
    }
  }

  // Returns none for paths that are diffuse, reversed or without exactly one hit beside those on flagged mirrors.
  std::optional<RouteKind> kind_of(int64_t path) const {
    const auto p = static_cast<size_t>(path);
    if (paths_.diffuse[p] != 0 || paths_.stratum[p] == kNoStratum || (paths_.flags[p] & kReversedPath) != 0)
      return std::nullopt;
    RouteKind kind{paths_.stratum[p], 0, {}, {}};
    int surfaces = 0;
    for (int k = 0; k < paths_.num_bounces[p]; ++k) {
      const uint32_t mesh = paths_.hits_of(path)[k].mesh_id;
      if (paths_.scene->node_of(mesh).material->mirror) {
        (surfaces == 0 ? kind.before : kind.behind).push_back(face_of(paths_.hits_of(path)[k]));
      } else {
        kind.mesh = mesh;
        ++surfaces;
      }
    }
    return surfaces == 1 ? std::optional(std::move(kind)) : std::nullopt;
  }

  Vec3 direction_of_launch(int64_t path) const {
    return (hit_point(pose_, paths_.hits_of(path)[0]) - paths_.frame.transmitter).normalized();
  }

  // Computes amplitudes without a filter, which are what one launch cell sends.
  void weigh_paths(Job* job) {
    std::vector<int64_t> indices;
    for (const auto& [kind, seen] : kinds_) {
      for (const SeenPath& one : seen) indices.push_back(one.path);
    }
    if (indices.empty()) return;
    const Radar radar = radar_of_rays(paths_.radar);
    const CellView unfiltered{0.0};
    std::vector<double> lengths;
    std::vector<std::complex<double>> amplitudes;
    Replayer(paths_, radar).evaluate(indices, paths_.frame.trace_time, {&unfiltered, 1}, lengths, amplitudes, job);
    size_t next = 0;
    for (auto& [kind, seen] : kinds_) {
      for (SeenPath& one : seen) one.amplitude = std::abs(amplitudes[next++]);
    }
  }

  MirrorFace face_of(const Hit& hit) const {
    return {hit.mesh_id, paths_.scene->node_of(hit.mesh_id).mesh->is_flat() ? kWholeMesh : hit.triangle_id};
  }

  // Returns the plane of the triangle, or that of the mesh's largest one: the others lie in it to a tenth of a millimetre.
  Plane plane_of(const MirrorFace& face) const {
    const auto& [mirror, only] = face;
    if (only != kWholeMesh) {
      const auto [a, b, c] = pose_.world_triangle(mirror, only);
      return {a, (b - a).cross(c - a).normalized()};
    }
    const uint32_t num_triangles = static_cast<uint32_t>(paths_.scene->node_of(mirror).mesh->triangles().size());
    Plane largest{Vec3::Zero(), Vec3::Zero()};  // the normal is as long as twice the area
    for (uint32_t triangle = 0; triangle < num_triangles; ++triangle) {
      const auto [a, b, c] = pose_.world_triangle(mirror, triangle);
      const Vec3 normal = (b - a).cross(c - a);
      if (normal.squaredNorm() > largest.normal.squaredNorm()) largest = {a, normal};
    }
    largest.normal.normalize();
    return largest;
  }

  Route route_of(const RouteKind& kind, const std::vector<SeenPath>& seen) const {
    Route route{seen, kind.stratum, {}, paths_.frame.transmitter, paths_.frame.receiver};
    for (const MirrorFace& mirror : kind.before) route.before.push_back(plane_of(mirror));
    for (const Plane& plane : route.before) route.first = plane.image(route.first);
    for (size_t k = kind.behind.size(); k-- > 0;) route.second = plane_of(kind.behind[k]).image(route.second);
    return route;
  }

  std::vector<MeshRoutes> posed(const std::map<uint32_t, std::vector<size_t>>& of_mesh, Job& job) const {
    std::vector<MeshRoutes> meshes;
    for (const auto& [mesh, routes] : of_mesh) meshes.push_back({mesh, routes, {}, {}});
    parallel_for(std::ssize(meshes), [&](int64_t i) {
      MeshRoutes& one = meshes[static_cast<size_t>(i)];
      one.vertices = pose_.world_vertices(one.mesh);
      one.normals = pose_.world_normals(one.mesh);
    }, &job);
    return meshes;
  }

  std::vector<Task> tasks_of(const std::vector<MeshRoutes>& meshes) const {
    constexpr size_t kTogether = 1 << 17;  // triangles times routes of a task
    std::vector<Task> tasks;
    for (const MeshRoutes& one : meshes) {
      const std::span<const Triangle> triangles(paths_.scene->node_of(one.mesh).mesh->triangles());
      const size_t step = std::max<size_t>(kTogether / one.routes.size(), 1);
      for (size_t begin = 0; begin < triangles.size(); begin += step)
        tasks.push_back({one, triangles.subspan(begin, std::min(step, triangles.size() - begin))});
    }
    return tasks;
  }

  // Most triangles turn their back to one end of every route, which is told before anything else is found out about them.
  std::vector<FoundGlint> glints_of(const Task& task, const std::vector<Route>& routes) const {
    const std::vector<Vec3>&vertices = task.of.vertices, &normals = task.of.normals;
    std::vector<FoundGlint> found;
    for (const Triangle& t : task.triangles) {
      const std::array<Vec3, 3> corners = {vertices[t[0]], vertices[t[1]], vertices[t[2]]};
      const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
      std::optional<ReflectingTriangle> triangle;
      for (const size_t index : task.of.routes) {
        const Route& route = routes[index];
        if (!(normal.dot(route.first - corners[0]) * normal.dot(route.second - corners[0]) > 0.0)) continue;
        if (!triangle) triangle = reflecting_triangle(corners, {normals[t[0]], normals[t[1]], normals[t[2]]});
        if (const std::optional<Glint> glint = glint_of(*triangle, route)) found.push_back({index, *glint});
      }
    }
    return found;
  }

  // Returns none where the triangle has no point of reflection, or no path ran beside it.
  std::optional<Glint> glint_of(const ReflectingTriangle& triangle, const Route& route) const {
    const std::optional<ReflectionPoint> point = find_reflection(triangle, route.first, route.second);
    if (!point) return std::nullopt;
    Glint glint = glint_at(*point, route.first, route.stratum);
    for (size_t k = route.before.size(); k-- > 0;) glint.direction = route.before[k].mirrored(glint.direction);
    const SeenPath* beside = nearest(route.seen, glint, cell_of(route.stratum));
    if (!beside) return std::nullopt;
    const double field = beside->amplitude * glint.narrow * glint.wide * paths_.frame.strata[route.stratum].ray_density;
    glint.power = field * field;
    return glint;
  }

  Glint glint_at(const ReflectionPoint& point, const Vec3& first, size_t stratum) const {
    const double wavenumber = kTwoPi * paths_.radar.waveform.start_frequency / kSpeedOfLight;
    const Vec3 line = point.position - first;
    const double distance = line.norm();
    double sizes[2];
    for (size_t i = 0; i < 2; ++i) {
      const Vec3 zone = std::sqrt(kTwoPi / (wavenumber * std::abs(point.bends[i]) + 1e-12)) * point.axes[i];
      sizes[i] = zone.cross(line).norm() / (distance * distance);
    }
    const Stratum& of = paths_.frame.strata[stratum];
    return {of.is_focus() ? of.focus_of : static_cast<int>(stratum), line / distance, 0.0, std::min(sizes[0], sizes[1]),
            std::max(sizes[0], sizes[1])};
  }

  double cell_of(size_t stratum) const { return 1.0 / std::sqrt(paths_.frame.lattice_density(stratum)); }  // rad

  // Returns the path beside a glint, or null.
  static const SeenPath* nearest(const std::vector<SeenPath>& seen, const Glint& glint, double cell) {
    const auto away = [&](const SeenPath& one) { return (one.direction - glint.direction).squaredNorm(); };
    const auto found =
        std::min_element(seen.begin(), seen.end(), [&](const SeenPath& a, const SeenPath& b) { return away(a) < away(b); });
    return away(*found) <= kBeside * kBeside * cell * cell ? &*found : nullptr;
  }

  const Paths& paths_;
  const PosedScene pose_;
  Kinds kinds_;
};

// Neighbouring triangles, and several records of one way, find the same point.
bool is_same(const Glint& a, const Glint& b) {
  if (a.is_chain != b.is_chain) return false;
  const double reach = std::max(kSamePoint * std::min(a.narrow, b.narrow), a.blur + b.blur);
  return (a.direction - b.direction).squaredNorm() < reach * reach;
}

}  // namespace

Radar radar_of_rays(const Radar& radar) {
  Radar one = radar;
  for (std::vector<Antenna>* antennas : {&one.transmitters, &one.receivers}) {
    const Vec3 mean = mean_position(*antennas, Transform::Identity());
    antennas->resize(1);
    antennas->front().position = mean;
  }
  return one;
}

std::vector<Glint> find_glints(const Paths& paths, Job* job) {
  std::vector<Glint> glints = GlintSearch(paths, job).find(job), chains = find_chain_glints(paths, job), kept;
  std::move(chains.begin(), chains.end(), std::back_inserter(glints));
  std::stable_sort(glints.begin(), glints.end(), [](const Glint& a, const Glint& b) { return a.power > b.power; });
  std::vector<std::vector<Glint>> of_stratum(paths.frame.strata.size());
  for (const Glint& glint : glints) {
    std::vector<Glint>& others = of_stratum[static_cast<size_t>(glint.stratum)];
    if (others.size() == kMaxGlints) continue;
    if (std::any_of(others.begin(), others.end(), [&](const Glint& other) { return is_same(glint, other); })) continue;
    others.push_back(glint);
    kept.push_back(glint);
  }
  return kept;
}

}  // namespace echopath
