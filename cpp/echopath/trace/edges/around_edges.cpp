#include "echopath/trace/edges/around_edges.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/em/edges/edge_shadow.h"
#include "echopath/posed/posed_scene.h"
#include "echopath/trace/edges/posed_edge.h"
#include "echopath/trace/embree/embree_scene.h"

namespace echopath {
namespace {

// Returns the edges of all meshes that nothing passes and that keep their shape.
std::vector<PosedEdge> opaque_edges(const Scene& scene, const PosedScene& pose, const Vec3& origin) {
  std::vector<PosedEdge> found;
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) {
    const Node& node = scene.node_of(id);
    if (!node.material->layers.empty() || node.deformation || scene.may_stretch(id)) continue;
    for (const SharpEdge& edge : node.mesh->sharp_edges()) found.push_back(posed_edge(edge, scene, pose, id, origin));
  }
  return found;
}

class AroundEdges {
 public:
  explicit AroundEdges(const AroundQuery& query)
      : query_(query), pose_(query.scene, query.time),
        geometry_(query.scene, pose_, EmbreeScene::origin_near(query.scene, pose_, query.antenna)),
        shift_(query.antenna - geometry_.origin()), edges_(opaque_edges(query.scene, pose_, query.antenna)),
        wavenumber_(kTwoPi * query.frequency / kSpeedOfLight) {}

  WayAroundEdge best_to(const Vec3& world) const {
    const Vec3 point = world - query_.antenna;
    WayAroundEdge best;
    if (is_clear(Vec3::Zero(), point)) {
      best.share = 1.0;
      best.length = point.norm();
      return best;
    }
    for (const PosedEdge& edge : edges_) take_better(edge, point, best);
    return best;
  }

 private:
  // The way ends a little before the point, which may lie on a surface.
  bool is_clear(const Vec3& from, const Vec3& to) const {
    return !geometry_.occluded(from + shift_, to + shift_ - 8.0 * geometry_.lift() * (to - from).normalized());
  }

  void take_better(const PosedEdge& edge, const Vec3& point, WayAroundEdge& best) const {
    const Vec3 axis = edge.line().normalized();
    const double before = -edge.from.dot(axis), behind = (point - edge.from).dot(axis);
    const double off_antenna = (edge.from + before * axis).norm(), off_point = (point - edge.from - behind * axis).norm();
    const double along = (before * off_point + behind * off_antenna) / std::max(off_antenna + off_point, 1e-12);
    if (along < 0.0 || along > edge.line().norm()) return;
    const Vec3 at = edge.from + along * axis;
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
  Vec3 shift_;                    // m, of the antenna in the geometry
  std::vector<PosedEdge> edges_;  // relative to the antenna
  double wavenumber_;             // rad/m
};

}  // namespace

std::vector<WayAroundEdge> ways_around_edges(const AroundQuery& query, const std::vector<Vec3>& points) {
  const AroundEdges around(query);
  std::vector<WayAroundEdge> ways;
  for (const Vec3& point : points) ways.push_back(around.best_to(point));
  return ways;
}

}  // namespace echopath
