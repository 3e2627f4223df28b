#include "echopath/sim/rays/glint_routes.h"

#include <complex>
#include <map>
#include <optional>
#include <tuple>

#include "echopath/record/hit_points.h"
#include "echopath/replay/replay.h"

namespace echopath {
namespace {

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

// Returns the radar with one antenna at each end, where the rays start and connect to.
Radar radar_of_rays(const Radar& radar) {
  Radar one = radar;
  for (std::vector<Antenna>* antennas : {&one.transmitters, &one.receivers}) {
    const Vec3 mean = mean_position(*antennas, Transform::Identity());
    antennas->resize(1);
    antennas->front().position = mean;
  }
  return one;
}

class RouteSorter {
 public:
  RouteSorter(const Paths& paths, const PosedScene& pose, Job* job) : paths_(paths), pose_(pose) {
    sort_paths(job);
    weigh_paths(job);
  }

  std::vector<GlintRoute> take_routes() {
    std::vector<GlintRoute> routes;
    for (auto& [kind, seen] : kinds_) routes.push_back(route_of(kind, std::move(seen)));
    return routes;
  }

 private:
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
    if (!paths_.is_coherent_with_cell(path) || paths_.is_reversed(path)) return std::nullopt;
    RouteKind kind{paths_.stratum[path], 0, {}, {}};
    int surfaces = 0;
    for (int k = 0; k < paths_.num_bounces[path]; ++k) {
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

  void weigh_paths(Job* job) {
    std::vector<int64_t> indices;
    for (const auto& [kind, seen] : kinds_) {
      for (const SeenPath& one : seen) indices.push_back(one.path);
    }
    if (indices.empty()) return;
    const std::vector<double> amplitudes = unfiltered_amplitudes(paths_, indices, job);
    size_t next = 0;
    for (auto& [kind, seen] : kinds_) {
      for (SeenPath& one : seen) one.amplitude = amplitudes[next++];
    }
  }

  MirrorFace face_of(const Hit& hit) const {
    return {hit.mesh_id, paths_.scene->node_of(hit.mesh_id).mesh->is_flat() ? kWholeMesh : hit.triangle_id};
  }

  // Returns the plane of the triangle, or that of the mesh's largest one: the others lie in it to a tenth of a millimetre.
  Plane plane_of(const MirrorFace& face) const {
    const auto& [mirror, only] = face;
    const bool is_whole = only == kWholeMesh;
    const size_t num_triangles = is_whole ? paths_.scene->node_of(mirror).mesh->triangles().size() : 1;
    return plane_of_largest(num_triangles, [&, first = is_whole ? 0 : only](size_t i) {
      return pose_.world_triangle(mirror, first + static_cast<uint32_t>(i));
    });
  }

  GlintRoute route_of(const RouteKind& kind, std::vector<SeenPath> seen) const {
    GlintRoute route{kind.mesh, kind.stratum, std::move(seen), {}, paths_.frame.transmitter, paths_.frame.receiver};
    for (const MirrorFace& mirror : kind.before) route.before.push_back(plane_of(mirror));
    std::vector<Plane> behind;
    for (const MirrorFace& mirror : kind.behind) behind.push_back(plane_of(mirror));
    route.first = image_over(route.before, route.first);
    route.second = image_over_reversed(behind, route.second);
    return route;
  }

  const Paths& paths_;
  const PosedScene& pose_;
  std::map<RouteKind, std::vector<SeenPath>> kinds_;
};

}  // namespace

std::vector<GlintRoute> glint_routes(const Paths& paths, const PosedScene& pose, Job* job) {
  return RouteSorter(paths, pose, job).take_routes();
}

std::vector<double> unfiltered_amplitudes(const Paths& paths, const std::vector<int64_t>& indices, Job* job) {
  const CellView unfiltered{0.0};
  std::vector<double> lengths, sizes;
  std::vector<std::complex<double>> amplitudes;
  const Radar radar = radar_of_rays(paths.radar);
  Replayer(paths, radar).evaluate(indices, paths.frame.trace_time, {&unfiltered, 1}, lengths, amplitudes, job);
  for (const std::complex<double>& amplitude : amplitudes) sizes.push_back(std::abs(amplitude));
  return sizes;
}

}  // namespace echopath
