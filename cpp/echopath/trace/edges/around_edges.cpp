#include "echopath/trace/edges/around_edges.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/em/edges/edge_shadow.h"
#include "echopath/posed/posed_scene.h"
#include "echopath/record/posed_edge.h"
#include "echopath/trace/embree/embree_scene.h"

namespace echopath {
namespace {

// Holds an edge, relative to the antenna, and where the antenna stands beside it.
struct EdgeSeen {
  EdgeSeen(const PosedEdge& edge)
      : mesh_id(edge.mesh_id), wedge(edge.wedge), from(edge.from), axis(edge.line().normalized()),
        length(edge.line().norm()), before(-from.dot(axis)), off_antenna((from + before * axis).norm()) {}

  uint32_t mesh_id;
  Wedge wedge;
  Vec3 from, axis;     // m, one end; unit vector to the other
  double length;       // m
  double before;       // m, of the antenna, along the axis
  double off_antenna;  // m, across it
};

// Returns the edges of all meshes that nothing passes and that keep their shape.
std::vector<EdgeSeen> opaque_edges(const Scene& scene, const PosedScene& pose, const Vec3& origin) {
  std::vector<EdgeSeen> found;
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) {
    const Node& node = scene.node_of(id);
    if (!node.material->layers.empty() || node.deformation || scene.may_stretch(id)) continue;
    for (const SharpEdge& edge : node.mesh->sharp_edges()) found.emplace_back(posed_edge(edge, scene, pose, id, origin));
  }
  return found;
}

class AroundEdges {
 public:
  explicit AroundEdges(const AroundQuery& query)
      : query_(query), pose_(query.scene, query.time),
        geometry_(query.scene, pose_, EmbreeScene::origin_near(query.scene, pose_, query.antenna)),
        shift_(query.antenna - geometry_.origin()), wavenumber_(kTwoPi * query.frequency / kSpeedOfLight) {
    if (query.edges) edges_ = opaque_edges(query.scene, pose_, query.antenna);
  }

  LegAroundEdge best_to(const Vec3& world) const {
    const Vec3 point = world - query_.antenna;
    LegAroundEdge best;
    if (is_clear(Vec3::Zero(), point)) {
      best.share = 1.0;
      best.length = point.norm();
      return best;
    }
    for (const EdgeSeen& edge : edges_) take_better(edge, point, best);
    return best;
  }

 private:
  // The way ends a little before the point, which may lie on a surface.
  bool is_clear(const Vec3& from, const Vec3& to) const {
    return !geometry_.occluded(from + shift_, to + shift_ - 8.0 * geometry_.lift() * (to - from).normalized());
  }

  void take_better(const EdgeSeen& edge, const Vec3& point, LegAroundEdge& best) const {
    const Vec3 from_end = point - edge.from;
    const double behind = from_end.dot(edge.axis);
    // Keller's point lies between the feet of both ends, so that most edges are left without a root.
    if (std::max(edge.before, behind) < 0.0 || std::min(edge.before, behind) > edge.length) return;
    const double off_point = (from_end - behind * edge.axis).norm();
    const double across = std::max(edge.off_antenna + off_point, 1e-12);
    const double along = (edge.before * off_point + behind * edge.off_antenna) / across;
    if (along < 0.0 || along > edge.length) return;
    const Vec3 at = edge.from + along * edge.axis;
    const double share = share_of(edge.wedge, at, point);
    if (share <= best.share) return;
    const Vec3 lifted = geometry_.lifted(at, outward_of(edge.wedge));
    if (!is_clear(lifted, Vec3::Zero()) || !is_clear(lifted, point)) return;
    best = {edge.mesh_id, at + query_.antenna, at.norm() + (point - at).norm(), share};
  }

  double share_of(const Wedge& wedge, const Vec3& at, const Vec3& point) const {
    const double in = at.norm(), out = (point - at).norm();
    if (std::min(in, out) * wavenumber_ < 1.0) return 0.0;
    const Vec3 arrival = at / in, departure = (point - at) / out;
    const Vec3 across = query_.polarization - arrival.dot(query_.polarization) * arrival;
    const double sine = axis_of(wedge).cross(arrival).norm();
    if (across.norm() < 1e-9 || sine < 1e-3) return 0.0;
    const double distance = in * out / (in + out);
    const Eigen::Matrix3cd matrix = diffraction_matrix(wedge, arrival, departure, wavenumber_ * distance);
    const double field = (matrix * across.normalized().cast<std::complex<double>>()).norm();
    const double zone = std::sqrt(kTwoPi * distance / wavenumber_) / sine;  // by stationary phase along the edge
    return point.norm() * field * zone / (4.0 * kPi * in * out);
  }

  AroundQuery query_;
  PosedScene pose_;
  EmbreeScene geometry_;
  Vec3 shift_;         // m, of the antenna in the geometry
  double wavenumber_;  // rad/m
  std::vector<EdgeSeen> edges_;
};

}  // namespace

std::vector<LegAroundEdge> legs_around_edges(const AroundQuery& query, const std::vector<Vec3>& points, Job* job) {
  const AroundEdges around(query);
  std::vector<LegAroundEdge> legs(points.size());
  if (job) job->start(std::ssize(points));
  parallel_for(std::ssize(points), [&](int64_t i) { legs[i] = around.best_to(points[i]); }, job);
  return legs;
}

}  // namespace echopath
