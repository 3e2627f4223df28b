#include "echopath/trace/edges/edges_over_planes.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "echopath/base/constants.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/em/edges/edge_shadow.h"
#include "echopath/trace/connect/mirror_orders.h"
#include "echopath/trace/edges/edge_coefficients.h"
#include "echopath/trace/mirrors/legs.h"

namespace echopath {
namespace {

// Rims of mirrors and the ends of what is lit count for whole pieces, so that these are shorter than edge_filter asks for.
constexpr double kFrontPhaseOverPlanes = 0.1;  // rad, quadratic phase over half a piece
constexpr double kOfLitEdge = 1.0 / 16;        // of the edge, a piece at most
constexpr double kOfWave = 0.5;                // wavelengths, the shortest piece for that

// Holds an edge, and what the antennas light over planes of its faces.
struct LitEdge : PosedEdge {
  std::vector<const LitPlane*> transmit, receive;
};

// Returns the stretch of a segment within a box, in shares of it; empty where the first is larger.
std::pair<double, double> stretch_within(const Vec3& from, const Vec3& to, const Box& box) {
  double begin = 0.0, end = 1.0;
  const Vec3 line = to - from;
  for (int axis = 0; axis < 3; ++axis) {
    double low = box.min()[axis] - from[axis], high = box.max()[axis] - from[axis];
    if (line[axis] == 0.0) {
      if (low > 0 || high < 0) return {1.0, 0.0};
      continue;
    }
    if (line[axis] < 0) std::swap(low, high);
    begin = std::max(begin, low / line[axis]);
    end = std::min(end, high / line[axis]);
  }
  return {begin, end};
}

// Finds what is lit of the edges, by the planes of their faces.
class EdgesOnPlanes {
 public:
  EdgesOnPlanes(const LitPlanes& lit, const std::vector<LitPlane>& of_antenna) : lit_(lit), by_plane_(lit.planes().size()) {
    for (const LitPlane& one : of_antenna) by_plane_[one.plane].push_back(&one);
  }

  std::vector<const LitPlane*> of(const PosedEdge& edge) const {
    std::vector<const LitPlane*> found;
    int before = -1;
    for (const WedgeFace& face : edge.wedge.faces) {
      const Vec3 inside = 0.5 * (edge.from + edge.to) + (edge.to - edge.from).norm() * face.inward;
      const int plane = lit_.plane_through(std::array<Vec3, 3>{edge.from, edge.to, inside}, face.normal);
      if (plane < 0 || plane == before) continue;
      before = plane;
      for (const LitPlane* one : by_plane_[plane]) {
        const auto [begin, end] = stretch_within(edge.from, edge.to, one->box);
        if (begin <= end) found.push_back(one);
      }
    }
    return found;
  }

 private:
  const LitPlanes& lit_;
  std::vector<std::vector<const LitPlane*>> by_plane_;
};

std::vector<LitEdge> lit_edges(const EdgeQuery& query, const LitPlanes& lit) {
  std::vector<LitEdge> found;
  const EdgesOnPlanes transmit(lit, lit.from_transmitter()), receive(lit, lit.from_receiver());
  for (const PosedEdge& edge : query.edges) {
    LitEdge one{edge, transmit.of(edge), receive.of(edge)};
    if (!one.transmit.empty() || !one.receive.empty()) found.push_back(std::move(one));
  }
  return found;
}

// Follows the legs to and from the pieces of one edge. It serves one thread.
template <class Coefficients>
class LitEdgeTracer {
 public:
  LitEdgeTracer(const EdgeQuery& query, const LitPlanes& lit, const LitEdge& edge, PathBlock& block)
      : query_(query), lit_(lit), edge_(edge), block_(block), outward_(outward_of(edge.wedge)),
        planes_(query.scene, query.geometry, lit, query.settings),
        finder_(query.geometry, query.mirrors, query.settings.frequency, query.settings.polarization) {}

  void trace() {
    num_pieces_ = num_pieces();
    for (int piece = 0; piece < num_pieces_; ++piece) add_piece((piece + 0.5) / num_pieces_);
  }

 private:
  // Describes a leg between the edge and an antenna with the field that it carries: it is direct, or goes over flagged
  // mirrors or over planes.
  struct WeightedLeg {
    std::vector<Hit> hits;  // from the edge toward the antenna
    EdgeLeg leg;
    std::complex<double> gain = 1.0;
    double share = 1.0;
    OrderShares orders;
    std::complex<double> past_edge = 0.0;  // share of what the edge sends over the leg to a mirror (kPastEdge)
  };

  EdgePoint point_at(double at) const {
    return point_on_edge(edge_, at, query_.geometry.corners(edge_.mesh_id, edge_.edge.triangle));
  }

  int num_pieces() const {
    const double wavenumber = kTwoPi * query_.settings.frequency / kSpeedOfLight, length = edge_.line().norm();
    const double by_phase =
        longest_piece(edge_, query_.settings.transmitter, query_.settings.receiver, wavenumber, kFrontPhaseOverPlanes);
    const double piece = std::min(by_phase, std::max(kOfLitEdge * length, kOfWave * kTwoPi / wavenumber));
    return static_cast<int>(std::clamp(std::ceil(length / piece), 1.0, double{kMostPieces}));
  }

  void add_piece(double at) {
    if (!is_within(edge_.transmit, at) && !is_within(edge_.receive, at)) return;
    const Vec3 &transmitter = query_.settings.transmitter, &receiver = query_.settings.receiver;
    const EdgePoint point = point_at(at);
    const std::vector<WeightedLeg> in_direct = direct(point, transmitter), out_direct = direct(point, receiver);
    const std::vector<WeightedLeg> in = over_planes(edge_.transmit, {point, at, transmitter, receiver, false}),
                                   out = over_planes(edge_.receive, {point, at, receiver, transmitter, !in_direct.empty()});
    if (in.empty() && out.empty()) return;
    ++block_.statistics.num_hits;
    for (const WeightedLeg& one : in) {
      for (const WeightedLeg& other : out) add_path(point, one, other, 1.0, 0);
      for (const WeightedLeg& other : out_direct) add_path(point, one, other, one.orders.own, 0);
    }
    for (const WeightedLeg& one : in_direct) {
      for (const WeightedLeg& other : out) {
        add_path(point, one, other, other.orders.opposite, kReversedPath);
        add_path(point, one, other, other.past_edge, kPastEdge);
      }
    }
  }

  bool is_within(const std::vector<const LitPlane*>& lit, double at) const {
    return std::ranges::any_of(lit, [&](const LitPlane* over) {
      const auto [begin, end] = stretch_within(edge_.from, edge_.to, over->box);
      return at >= begin && at <= end;
    });
  }

  // Asks for the legs from a point of the edge, `at` in [0, 1] of it, to an antenna.
  struct PlaneLegQuery {
    EdgePoint point;
    double at;
    Vec3 antenna, other;
    bool is_end;  // waves leave the edge over these legs, to which they came directly
  };

  std::vector<WeightedLeg> over_planes(const std::vector<const LitPlane*>& lit, const PlaneLegQuery& query) {
    std::vector<WeightedLeg> legs;
    for (const LitPlane* over : lit) {
      const auto [begin, end] = stretch_within(edge_.from, edge_.to, over->box);
      if (query.at < begin || query.at > end || std::ssize(over->mirrors) >= query_.settings.max_bounces) continue;
      const std::optional<PlaneLeg> leg =
          planes_.find(query.point.position, outward_, query.antenna, *over, block_.statistics.num_queries);
      if (!leg || !may_leave(edge_.wedge, leg->to_antenna, leg->length)) continue;
      WeightedLeg& weighted = legs.emplace_back();
      for (const RayHit& bounce : leg->bounces) weighted.hits.push_back(bounce.hit);
      weighted.leg = {leg->to_antenna, leg->at_antenna, leg->length};
      weighted.gain = leg->gain;
      weighted.share = leg->share;
      weighted.orders = kept_orders(*leg, *over, query);
      if (query.is_end && weighted.orders.opposite < 1.0) {
        weighted.past_edge =
            (1.0 - weighted.orders.opposite) *
            planes_.field_beside_rims(query.point.position, query.antenna, *leg, block_.statistics.num_queries);
      }
    }
    return legs;
  }

  std::vector<WeightedLeg> direct(const EdgePoint& point, const Vec3& antenna) {
    LegQuery query{point.position, outward_, 0};
    query.faces_all = true;
    finder_.find(query, {antenna, {}, {}}, legs_, search_);
    block_.statistics.num_queries += std::exchange(search_.num_queries, 0);
    std::vector<WeightedLeg> legs;
    for (const Leg& leg : legs_) {
      if (!may_leave(edge_.wedge, leg.to_antenna, leg.length)) continue;
      WeightedLeg& weighted = legs.emplace_back();
      weighted.leg = {leg.to_antenna, leg.at_antenna, leg.length};
      weighted.gain = leg.gain;
    }
    return legs;
  }

  // Returns the shares of the orders, which the pieces of one edge have in common: those in the middle of what is lit of it,
  // whichever end comes first, or of the leg at hand where the middle has none.
  OrderShares kept_orders(const PlaneLeg& leg, const LitPlane& over, const PlaneLegQuery& query) {
    if (const auto known = orders_.find(&over); known != orders_.end()) return known->second;
    const auto [begin, end] = stretch_within(edge_.from, edge_.to, over.box);
    const Vec3 middle = point_at(0.5 * (begin + end)).position;
    const std::optional<PlaneLeg> of_middle =
        planes_.find(middle, outward_, query.antenna, over, block_.statistics.num_queries);
    const Vec3& point = of_middle ? middle : query.point.position;
    OrderShares orders = orders_of(of_middle.value_or(leg), point, over, query.other);
    if (meets_next_plane(point, over)) orders.opposite = 0.0;
    return orders_[&over] = orders;
  }

  // Returns the shares of both orders in which rays go over these planes and the face of the edge, to the other antenna.
  // `leg` begins at `point` of the edge.
  OrderShares orders_of(const PlaneLeg& leg, const Vec3& point, const LitPlane& over, const Vec3& other) {
    const Plane& plane = lit_.planes()[over.plane];
    const Vec3 normal = plane.height(point + leg.to_antenna) >= plane.height(point) ? plane.normal : Vec3(-plane.normal);
    const Vec3 middle = over.box.center() - plane.height(over.box.center()) * plane.normal;
    RayHit face;
    ++block_.statistics.num_queries;
    const double above = 0.5 * over.box.diagonal().norm();
    if (query_.geometry.intersect_from_surface(middle + above * normal, -normal, face) != EmbreeScene::Verdict::kHit ||
        lit_.plane_of(face.hit) != over.plane)
      return {};
    const Vec3 line = face.position - other;
    const double behind = (leg.bounces.front().position - face.position).norm();
    return order_shares(
        leg.first_cover,
        std::max(planes_.cover_of(face, line.normalized(), line.norm(), behind, block_.statistics.num_queries), 1e-9));
  }

  // Returns whether the lit face goes on from a point of the edge to the plane that is next to it, as in a corner.
  bool meets_next_plane(const Vec3& point, const LitPlane& over) {
    const int next = over.mirrors.back();
    const Plane& mirror = lit_.planes()[next];
    const double gap = query_.geometry.plane_tolerance(kSpeedOfLight / query_.settings.frequency);
    for (const WedgeFace& face : edge_.wedge.faces) {
      const Vec3 from = point + gap * (face.inward + face.normal);
      RayHit met;
      block_.statistics.num_queries += 2;
      if (query_.geometry.intersect_from_surface(from, face.inward, met) != EmbreeScene::Verdict::kHit ||
          lit_.plane_of(met.hit) != next || std::abs(mirror.height(point)) < gap)
        continue;
      const Vec3 beside = from + std::max(met.distance - 2.0 * gap, 0.0) * face.inward;
      if (query_.geometry.intersect_from_surface(beside, -face.normal, met) == EmbreeScene::Verdict::kHit &&
          met.distance < 2.0 * gap)
        return true;
    }
    return false;
  }

  // Returns whether an echo is to be kept. What an edge sends to a mirror is largest where no transition weakens it.
  bool is_strong(const WeightedLeg& in, const WeightedLeg& out, std::complex<double> weight, bool is_past_edge) const {
    if (query_.least_power == 0.0) return true;
    constexpr double kFarFromTransition = 1e6;  // rad
    const Vec3 arrival = -in.leg.to_antenna, &departure = out.leg.to_antenna;
    const double coupled = is_past_edge ? diffraction_matrix(edge_.wedge, arrival, departure, kFarFromTransition).norm()
                                        : fringe_matrix(edge_.wedge, arrival, departure).norm();
    return query_.estimate.power(edge_.wedge, in.leg, out.leg, std::abs(weight) * coupled) >= query_.least_power;
  }

  void add_path(const EdgePoint& point, const WeightedLeg& in, const WeightedLeg& out, std::complex<double> share,
                uint32_t flag) {
    if (share == 0.0 || std::ssize(in.hits) + 1 + std::ssize(out.hits) > query_.settings.max_bounces) return;
    const WeightedLeg& first = (flag & kReversedPath) != 0 ? out : in;  // from which the wave comes
    const Material& material = *query_.scene.node_of(edge_.mesh_id).material;
    const double kept = kept_share(material, query_.settings.frequency, edge_.wedge, first.leg.to_antenna);
    const std::complex<double> weight = share * in.share * out.share * kept * Coefficients::held(in.gain * out.gain);
    if (!is_strong(in, out, weight, flag == kPastEdge)) return;
    std::vector<Hit> hits(in.hits.rbegin(), in.hits.rend());
    const int at = static_cast<int>(hits.size());
    hits.push_back(point.hit);
    hits.insert(hits.end(), out.hits.begin(), out.hits.end());
    block_.add(hits.data(), static_cast<int>(hits.size()), 0, std::complex<float>(weight), kNoStratum);
    block_.set_edge(at, num_pieces_);
    block_.rows.flags[block_.rows.size() - 1] |= flag;
    Coefficients::add_matrix(block_);
  }

  const EdgeQuery& query_;
  const LitPlanes& lit_;
  const LitEdge& edge_;
  PathBlock& block_;
  Vec3 outward_;
  PlaneLegFinder planes_;
  LegFinder finder_;
  std::vector<Leg> legs_;
  LegSearch search_;
  std::map<const LitPlane*, OrderShares> orders_;  // by what is lit
  int num_pieces_ = 1;
};

template <class Coefficients>
std::vector<PathBlock> paths_over_planes(const EdgeQuery& query, const LitPlanes& lit, Job* job) {
  const std::vector<LitEdge> edges = lit_edges(query, lit);
  std::vector<PathBlock> blocks(edges.size());
  Job own(job);
  parallel_for(std::ssize(blocks), [&](int64_t i) { LitEdgeTracer<Coefficients>(query, lit, edges[i], blocks[i]).trace(); },
               &own);
  return blocks;
}

}  // namespace

std::vector<PathBlock> find_edges_over_planes(const EdgeQuery& query, const LitPlanes& lit, Job* job) {
  if (query.settings.is_polarized) return paths_over_planes<JonesCoefficients>(query, lit, job);
  return paths_over_planes<ScalarCoefficients>(query, lit, job);
}

}  // namespace echopath
