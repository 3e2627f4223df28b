#include "echopath/sim/rays/find_glints.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <span>

#include "echopath/base/constants.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/scene/smooth/reflection_point.h"
#include "echopath/sim/rays/chain_glints.h"
#include "echopath/sim/rays/glint_routes.h"

namespace echopath {
namespace {

constexpr double kBeside = 1.5;     // cells: a point of reflection is seen where a path lies this near
constexpr double kSamePoint = 0.5;  // of the narrower Fresnel zone

class GlintSearch {
 public:
  GlintSearch(const Paths& paths, Job* job)
      : paths_(paths), pose_(*paths.scene, paths.frame.trace_time), routes_(glint_routes(paths, pose_, job)) {}

  std::vector<Glint> find(Job* job) const {
    Job unseen(job);
    const std::vector<MeshRoutes> meshes = posed(unseen);
    const std::vector<Task> tasks = tasks_of(meshes);
    std::vector<std::vector<FoundGlint>> found(tasks.size());
    parallel_for(std::ssize(tasks), [&](int64_t i) { found[i] = glints_of(tasks[i]); }, &unseen);
    std::vector<std::vector<Glint>> of_route(routes_.size());
    for (const std::vector<FoundGlint>& some : found) {
      for (const FoundGlint& one : some) of_route[one.route].push_back(one.glint);
    }
    std::vector<Glint> glints;
    for (const std::vector<Glint>& some : of_route) glints.insert(glints.end(), some.begin(), some.end());
    return glints;
  }

 private:
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

  std::vector<MeshRoutes> posed(Job& job) const {
    std::map<uint32_t, std::vector<size_t>> of_mesh;  // indices of routes
    for (size_t route = 0; route < routes_.size(); ++route) of_mesh[routes_[route].mesh].push_back(route);
    std::vector<MeshRoutes> meshes;
    for (const auto& [mesh, routes] : of_mesh) meshes.push_back({mesh, routes, {}, {}});
    parallel_for(std::ssize(meshes), [&](int64_t i) {
      MeshRoutes& one = meshes[i];
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
  std::vector<FoundGlint> glints_of(const Task& task) const {
    const std::vector<Vec3>&vertices = task.of.vertices, &normals = task.of.normals;
    std::vector<FoundGlint> found;
    for (const Triangle& t : task.triangles) {
      const std::array<Vec3, 3> corners = {vertices[t[0]], vertices[t[1]], vertices[t[2]]};
      const Vec3 normal = cross_of_sides(corners);
      std::optional<ReflectingTriangle> triangle;
      for (const size_t index : task.of.routes) {
        const GlintRoute& route = routes_[index];
        if (!faces_both(corners[0], normal, route.first, route.second)) continue;
        if (!triangle) triangle = reflecting_triangle(corners, {normals[t[0]], normals[t[1]], normals[t[2]]});
        if (const std::optional<Glint> glint = glint_of(*triangle, route)) found.push_back({index, *glint});
      }
    }
    return found;
  }

  // Returns none where the triangle has no point of reflection, or no path ran beside it.
  std::optional<Glint> glint_of(const ReflectingTriangle& triangle, const GlintRoute& route) const {
    const std::optional<ReflectionPoint> point = find_reflection(triangle, route.first, route.second);
    if (!point) return std::nullopt;
    Glint glint = glint_at(*point, route.first, route.stratum);
    glint.direction = mirrored_over_reversed(route.before, glint.direction);
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
      const Vec3 zone = std::sqrt(kTwoPi / (wavenumber * std::abs(point.second_derivatives[i]) + 1e-12)) * point.axes[i];
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
    const auto found = std::ranges::min_element(seen, {}, away);
    return away(*found) <= kBeside * kBeside * cell * cell ? &*found : nullptr;
  }

  const Paths& paths_;
  const PosedScene pose_;
  const std::vector<GlintRoute> routes_;
};

// Neighbouring triangles, and several records of one way, find the same point.
bool is_same(const Glint& a, const Glint& b) {
  if (a.is_chain != b.is_chain) return false;
  const double reach = std::max(kSamePoint * std::min(a.narrow, b.narrow), a.blur + b.blur);
  return (a.direction - b.direction).squaredNorm() < reach * reach;
}

}  // namespace

std::vector<Glint> find_glints(const Paths& paths, Job* job) {
  std::vector<Glint> glints = GlintSearch(paths, job).find(job), chains = find_chain_glints(paths, job), kept;
  std::move(chains.begin(), chains.end(), std::back_inserter(glints));
  std::ranges::stable_sort(glints, std::greater(), &Glint::power);
  std::vector<std::vector<Glint>> of_stratum(paths.frame.strata.size());
  for (const Glint& glint : glints) {
    std::vector<Glint>& others = of_stratum[glint.stratum];
    if (others.size() == kMaxGlints) continue;
    if (std::ranges::any_of(others, [&](const Glint& other) { return is_same(glint, other); })) continue;
    others.push_back(glint);
    kept.push_back(glint);
  }
  return kept;
}

}  // namespace echopath
