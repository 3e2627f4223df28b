#include "echopath/trace/edges/around_edges.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>

#include "echopath/base/constants.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/em/edges/edge_shadow.h"
#include "echopath/posed/posed_scene.h"
#include "echopath/record/posed_edge.h"
#include "echopath/trace/embree/embree_scene.h"

namespace echopath {
namespace {

constexpr double kFaintest = 0.03;   // of the field of the strongest way: fainter ones are left out
constexpr double kAlongFace = 1e-6;  // sine of the angle to a face below which a way runs along it

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

// Returns whether the unit vector `departure` from the edge runs along a face of its wedge.
bool runs_along_face(const Wedge& wedge, const Vec3& departure) {
  return std::ranges::any_of(wedge.faces, [&](const WedgeFace& face) {
    return std::abs(face.normal.dot(departure)) < kAlongFace && face.inward.dot(departure) > 0.0;
  });
}

class AroundEdges {
 public:
  explicit AroundEdges(const AroundQuery& query)
      : query_(query), pose_(query.scene, query.time),
        geometry_(query.scene, pose_, EmbreeScene::origin_near(query.scene, pose_, query.antenna)),
        shift_(query.antenna - geometry_.origin()), wavenumber_(kTwoPi * query.frequency / kSpeedOfLight) {
    if (query.edges) edges_ = opaque_edges(query.scene, pose_, query.antenna);
  }

  LegAroundEdge leg_to(const Vec3& world) const {
    const Vec3 point = world - query_.antenna;
    LegAroundEdge leg;
    if (is_clear(Vec3::Zero(), point)) {
      leg.share = 1.0;
      leg.length = point.norm();
      return leg;
    }
    thread_local std::vector<Way> ways;
    ways.clear();
    for (const EdgeSeen& edge : edges_) add_way(edge, point, ways);
    std::ranges::stable_sort(ways, std::greater(), &Way::share);
    keep_separate(point, ways);
    if (ways.empty()) return leg;
    const Way& strongest = ways.front();
    leg = {strongest.edge->mesh_id, strongest.at + query_.antenna, strongest.length, share_of(ways)};
    return leg;
  }

 private:
  // Holds a way around one edge, and what of the field it brings.
  struct Way {
    const EdgeSeen* edge;
    Vec3 at;                 // m, from the antenna: on the edge
    Eigen::Vector3cd field;  // over that which nothing would hide, without the phase of the length
    double length, share;    // m; norm of the field
  };

  // The way ends a little before the point, which may lie on a surface.
  bool is_clear(const Vec3& from, const Vec3& to) const {
    return !geometry_.occluded(from + shift_, to + shift_ - 8.0 * geometry_.lift() * (to - from).normalized());
  }

  // Adds the way around an edge, if it has one, whether it is free or not.
  void add_way(const EdgeSeen& edge, const Vec3& point, std::vector<Way>& ways) const {
    const Vec3 from_end = point - edge.from;
    const double behind = from_end.dot(edge.axis);
    // Keller's point lies between the feet of both ends, so that most edges are left without a root.
    if (std::max(edge.before, behind) < 0.0 || std::min(edge.before, behind) > edge.length) return;
    const double off_point = (from_end - behind * edge.axis).norm();
    const double across = std::max(edge.off_antenna + off_point, 1e-12);
    const double along = (edge.before * off_point + behind * edge.off_antenna) / across;
    if (along < 0.0 || along > edge.length) return;
    const Vec3 at = edge.from + along * edge.axis;
    const Eigen::Vector3cd field = field_over(edge.wedge, at, point);
    const double share = field.norm();
    if (share > 0.0) ways.push_back({&edge, at, field, at.norm() + (point - at).norm(), share});
  }

  // Keeps of ways, the strongest first, those that are free and no fainter than kFaintest of the strongest of them. Edges
  // within half a Fresnel zone of a stronger one, as rims of two walls that meet, are one edge with it.
  void keep_separate(const Vec3& point, std::vector<Way>& ways) const {
    size_t num_kept = 0;
    for (size_t i = 0; i < ways.size(); ++i) {
      if (num_kept > 0 && ways[i].share < kFaintest * ways.front().share) break;
      const Vec3& at = ways[i].at;
      const double in = at.norm(), out = (point - at).norm();
      const double apart = std::sqrt(0.5 * kPi / wavenumber_ * in * out / (in + out));
      const bool is_one = std::any_of(ways.begin(), ways.begin() + static_cast<std::ptrdiff_t>(num_kept),
                                      [&](const Way& stronger) { return (stronger.at - at).norm() < apart; });
      const Vec3 lifted = geometry_.lifted(at, outward_of(ways[i].edge->wedge));
      if (is_one || !is_clear(lifted, Vec3::Zero()) || !is_clear(lifted, point)) continue;
      ways[num_kept++] = ways[i];
    }
    ways.resize(num_kept);
  }

  double share_of(const std::vector<Way>& ways) const {
    Eigen::Vector3cd field = Eigen::Vector3cd::Zero();
    for (const Way& way : ways) field += std::polar(1.0, -wavenumber_ * (way.length - ways.front().length)) * way.field;
    return field.norm();
  }

  Eigen::Vector3cd field_over(const Wedge& wedge, const Vec3& at, const Vec3& point) const {
    const double in = at.norm(), out = (point - at).norm();
    if (std::min(in, out) * wavenumber_ < 1.0) return Eigen::Vector3cd::Zero();
    const Vec3 arrival = at / in, departure = (point - at) / out;
    const Vec3 across = query_.polarization - arrival.dot(query_.polarization) * arrival;
    const double sine = axis_of(wedge).cross(arrival).norm();
    if (across.norm() < 1e-9 || sine < 1e-3 || runs_along_face(wedge, departure)) return Eigen::Vector3cd::Zero();
    const double distance = in * out / (in + out);
    const Eigen::Matrix3cd matrix = diffraction_matrix(wedge, arrival, departure, wavenumber_ * distance);
    const double zone = std::sqrt(kTwoPi * distance / wavenumber_) / sine;  // by stationary phase along the edge
    return point.norm() * zone / (4.0 * kPi * in * out) * (matrix * across.normalized().cast<std::complex<double>>());
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
  parallel_for(std::ssize(points), [&](int64_t i) { legs[i] = around.leg_to(points[i]); }, job);
  return legs;
}

}  // namespace echopath
