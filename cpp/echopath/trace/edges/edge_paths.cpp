#include "echopath/trace/edges/edge_paths.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/base/parallel.h"
#include "echopath/scene/scene_edges.h"
#include "echopath/trace/edges/edge_chains.h"
#include "echopath/trace/edges/posed_edge.h"
#include "echopath/trace/mirrors/legs.h"
#include "echopath/trace/near_antenna.h"

namespace echopath {
namespace {

constexpr size_t kEdgesPerBlock = 64;
constexpr double kBentFront = 0.8;    // rad, of the wave fronts over half a piece (edge_filter)
constexpr double kOfBody = 1.0 / 16;  // of the extent of a body, a piece at most where a part of the edge is hidden
constexpr double kLeastChain = 0.03;  // of what the edge of a half plane sends

AntennaView view_for_edges(const Vec3& antenna, const MirrorFrusta& found, const EdgeQuery& query) {
  if (!query.frusta.serve_legs) return {antenna, {}, {}};
  return view_of(antenna, with_at_most(found, most_leg_mirrors(query.settings)));
}

// Returns all edges of a scene, and the extent of the body that each mesh belongs to.
struct EdgesOfScene {
  std::vector<PosedEdge> edges;
  std::vector<double> extent;  // m, by mesh ID
};

EdgesOfScene edges_of(const EdgeQuery& query) {
  const SceneEdges found(query.scene);
  EdgesOfScene all;
  std::vector<Eigen::AlignedBox3d> box(query.scene.meshes().size());
  for (uint32_t id = 0; id < box.size(); ++id) {
    if (found.of(id).empty()) continue;
    box[found.body_of(id)].extend(query.geometry.box(id));
    for (const SharpEdge& edge : found.of(id)) {
      const auto corners = query.geometry.corners(id, edge.triangle);
      const Vec3 &from = corners[edge.side], line = corners[(edge.side + 1) % 3] - from;
      all.edges.push_back({id, edge, posed_wedge(edge, query.pose, id), from + edge.begin * line, from + edge.end * line});
    }
  }
  for (uint32_t id = 0; id < box.size(); ++id) {
    const Eigen::AlignedBox3d& body = box[found.body_of(id)];
    all.extent.push_back(body.isEmpty() ? 0.0 : body.diagonal().norm());
  }
  return all;
}

class EdgeTracer {
 public:
  EdgeTracer(const EdgeQuery& query, const EdgesOfScene& all)
      : query_(query), all_(all), wavenumber_(kTwoPi * query.settings.frequency / kSpeedOfLight),
        chains_(all.edges, kTwoPi / wavenumber_),
        finder_(query.geometry, query.mirrors, query.settings.frequency, query.settings.polarization),
        transmitter_(view_for_edges(query.settings.transmitter, query.frusta.transmitter, query)),
        receiver_(view_for_edges(query.settings.receiver, query.frusta.receiver, query)) {}

  // Holds what is needed while one thread follows edges.
  struct Scratch {
    std::vector<Leg> in, out, behind;
    LegSearch search;
    std::vector<Hit> hits;     // of the pieces of one edge
    std::vector<Vec3> points;  // likewise
    std::vector<ShadowState> to_transmitter, to_receiver;
    std::vector<Segment> segments;
    std::vector<uint8_t> blocked;
  };

  void add(size_t edge, Scratch& scratch, PathBlock& block) const {
    const PosedEdge& one = all_.edges[edge];
    const double longest = longest_piece(one);
    set_pieces(one, std::min(longest, kOfBody * all_.extent[one.mesh_id]), scratch);
    look(one.wedge, query_.settings.transmitter, scratch, scratch.to_transmitter);
    look(one.wedge, query_.settings.receiver, scratch, scratch.to_receiver);
    const auto is_open = [](ShadowState state) { return state == ShadowState::kOpen; };
    if (std::all_of(scratch.to_transmitter.begin(), scratch.to_transmitter.end(), is_open) &&
        std::all_of(scratch.to_receiver.begin(), scratch.to_receiver.end(), is_open))
      set_pieces(one, longest, scratch);
    for (size_t piece = 0; piece < scratch.points.size(); ++piece) add_point(edge, piece, scratch, block);
  }

 private:
  // Returns how long a piece may be for the fronts of the waves, m.
  double longest_piece(const PosedEdge& edge) const {
    const auto inverse = [&](const Vec3& antenna) {
      return 1.0 / std::max(distance_to_segment(antenna, edge.from, edge.to), kNearAntenna);
    };
    const double bend = wavenumber_ * (inverse(query_.settings.transmitter) + inverse(query_.settings.receiver));
    return std::sqrt(8.0 * kBentFront / bend);
  }

  void set_pieces(const PosedEdge& one, double longest, Scratch& scratch) const {
    const SharpEdge& edge = one.edge;
    const auto corners = query_.geometry.corners(one.mesh_id, edge.triangle);
    const auto num_pieces =
        static_cast<int>(std::clamp(std::ceil((one.to - one.from).norm() / longest), 1.0, double{kMostPieces}));
    scratch.hits.clear();
    scratch.points.clear();
    for (int piece = 0; piece < num_pieces; ++piece) {
      const PointOnSide at = point_on_side(edge.side, edge.begin + (edge.end - edge.begin) * (piece + 0.5) / num_pieces);
      scratch.hits.emplace_back(one.mesh_id, edge.triangle, at.u, at.v);
      scratch.points.push_back(corners[0] + double{at.u} * (corners[1] - corners[0]) +
                               double{at.v} * (corners[2] - corners[0]));
    }
  }

  // Looks from all pieces to an antenna at once.
  void look(const Wedge& wedge, const Vec3& antenna, Scratch& scratch, std::vector<ShadowState>& states) const {
    const Vec3 outward = outward_of(wedge);
    states.assign(scratch.points.size(), ShadowState::kBlocked);
    scratch.segments.clear();
    for (size_t i = 0; i < scratch.points.size(); ++i) {
      const Vec3 line = antenna - scratch.points[i];
      if (line.norm() < kNearAntenna || !is_outside(wedge, line)) continue;
      states[i] = ShadowState::kOpen;
      scratch.segments.push_back({query_.geometry.lifted(scratch.points[i], outward), antenna});
    }
    scratch.blocked.resize(scratch.segments.size());
    scratch.search.num_queries += std::ssize(scratch.segments);
    query_.geometry.occluded(scratch.segments.data(), scratch.segments.size(), scratch.blocked.data());
    auto blocked = scratch.blocked.begin();
    for (ShadowState& state : states) {
      if (state == ShadowState::kOpen && *blocked++) state = ShadowState::kBlocked;
    }
  }

  // Finds the legs from a point to an antenna that leave into the space around the edge.
  void find_legs(const Vec3& point, const Wedge& wedge, const AntennaView& antenna, ShadowState direct,
                 std::vector<Leg>& legs, LegSearch& search) const {
    LegQuery query{point, outward_of(wedge), std::min(query_.settings.max_bounces - 1, most_leg_mirrors(query_.settings))};
    query.faces_all = true;
    query.direct = direct;
    finder_.find(query, antenna, legs, search);
    std::erase_if(legs, [&](const Leg& leg) { return leg.length < kNearAntenna || !is_outside(wedge, leg.to_antenna); });
  }

  void add_point(size_t edge, size_t piece, Scratch& scratch, PathBlock& block) const {
    const Wedge& wedge = all_.edges[edge].wedge;
    const Vec3& point = scratch.points[piece];
    ++block.statistics.num_hits;
    find_legs(point, wedge, transmitter_, scratch.to_transmitter[piece], scratch.in, scratch.search);
    if (scratch.in.empty()) return;
    find_legs(point, wedge, receiver_, scratch.to_receiver[piece], scratch.out, scratch.search);
    const std::span<const Hit> hit(&scratch.hits[piece], 1);
    const int num_pieces = static_cast<int>(scratch.points.size());
    for (const Leg& in : scratch.in) {
      for (const Leg& out : scratch.out) add_path(in, hit, out, wedge, num_pieces, block);
      const auto add_way = [&](const EdgeWay& way, size_t last) {
        return add_chain(in, way, last, num_pieces, scratch, block);
      };
      const int most = std::min(kMostEdges, query_.settings.max_bounces - in.num_bounces);
      chains_.follow(edge, scratch.hits[piece], point, -in.to_antenna, most, add_way);
    }
  }

  // Adds the paths that end with the last edge of a way; returns whether the wave there is strong enough to go on.
  bool add_chain(const Leg& in, const EdgeWay& way, size_t last, int num_pieces, Scratch& scratch, PathBlock& block) const {
    const std::optional<EdgeChain> chain = EdgeChain::over(way.edges, wavenumber_);
    if (!chain) return false;
    const double entered = strength(*chain, in);
    const Wedge& wedge = all_.edges[last].wedge;
    const Vec3 point = way.edges.back().point, line = query_.settings.receiver - point;
    const bool is_lit = line.norm() > kNearAntenna && is_outside(wedge, line);
    const bool is_strong = is_lit && matters(*chain, entered, line.normalized(), line.norm());
    const bool goes_on = entered > kLeastChain;
    if (!is_strong && (receiver_.frusta.empty() || !goes_on)) return goes_on;
    find_legs(point, wedge, receiver_, is_strong ? ShadowState::kUnknown : ShadowState::kBlocked, scratch.behind,
              scratch.search);
    for (const Leg& out : scratch.behind) {
      if (matters(*chain, entered, out.to_antenna, out.length)) add_path(in, way.hits, out, wedge, num_pieces, block);
    }
    return goes_on;
  }

  Vec3 polarization_across(const Vec3& direction) const {
    const Vec3& along = query_.settings.polarization;
    return (along - direction.dot(along) * direction).normalized();
  }

  // Returns the strength on the last face for the polarisation that makes most of it, in the scalar model for its own.
  double strength(const EdgeChain& chain, const Leg& leg) const {
    const Vec3 in = -leg.to_antenna, first = query_.settings.is_polarized ? in.unitOrthogonal() : polarization_across(in);
    const auto entered = [&](const Vec3& field) {
      return std::abs(chain.enter(in, field.cast<std::complex<double>>(), leg.length));
    };
    return query_.settings.is_polarized ? std::hypot(entered(first), entered(in.cross(first))) : entered(first);
  }

  // Returns whether a chain sends at least kLeastChain of the edge of a half plane, likewise.
  bool matters(const EdgeChain& chain, double entered, const Vec3& out, double distance) const {
    constexpr double kOfHalfPlane = 2.0;
    // What leaves an edge is largest about the direction of the wave.
    const double most = 4.0 * std::sqrt(2.0 / std::max(1.0 - chain.arrival().dot(out), 1e-12));
    if (entered * most < kOfHalfPlane * kLeastChain) return false;
    const FieldVector left = chain.leave(out, distance);
    const double taken = query_.settings.is_polarized
                             ? left.norm()
                             : std::abs((polarization_across(out).cast<std::complex<double>>().transpose() * left).value());
    return entered * taken > kOfHalfPlane * kLeastChain;
  }

  // `wedge` is that of the last edge; the share of the field that stays in phase is taken from it.
  void add_path(const Leg& in, std::span<const Hit> on_edges, const Leg& out, const Wedge& wedge, int num_pieces,
                PathBlock& block) const {
    if (in.num_bounces + std::ssize(on_edges) + out.num_bounces > query_.settings.max_bounces) return;
    std::array<Hit, 2 * kMaxLegMirrors + kMostEdges> hits;
    int count = 0;
    for (int k = in.num_bounces; k-- > 0;) hits[static_cast<size_t>(count++)] = in.bounces[static_cast<size_t>(k)].hit;
    const int at = count;
    for (const Hit& hit : on_edges) hits[static_cast<size_t>(count++)] = hit;
    for (int k = 0; k < out.num_bounces; ++k) hits[static_cast<size_t>(count++)] = out.bounces[static_cast<size_t>(k)].hit;
    const std::complex<double> over_mirrors = query_.settings.is_polarized ? 1.0 : in.gain * out.gain;
    const Material& material = *query_.scene.node_of(on_edges.back().mesh_id).material;
    const double kept = kept_share(material, query_.settings.frequency, wedge, in.to_antenna);
    const std::complex<double> weight = kept * over_mirrors;
    block.add(hits.data(), count, 0, std::complex<float>(weight), kNoStratum);
    block.set_edge(at, num_pieces, static_cast<int>(on_edges.size()));
    if (query_.settings.is_polarized) block.set_jones({1.0f, 0.0f, 0.0f, 1.0f});
  }

  const EdgeQuery& query_;
  const EdgesOfScene& all_;
  double wavenumber_;  // rad/m
  EdgeChains chains_;
  LegFinder finder_;
  AntennaView transmitter_, receiver_;
};

}  // namespace

std::vector<PathBlock> find_edge_paths(const EdgeQuery& query, Job* job) {
  const EdgesOfScene all = edges_of(query);
  const EdgeTracer tracer(query, all);
  std::vector<PathBlock> blocks((all.edges.size() + kEdgesPerBlock - 1) / kEdgesPerBlock);
  Job own(job);
  parallel_for(std::ssize(blocks), [&](int64_t i) {
    PathBlock& block = blocks[static_cast<size_t>(i)];
    EdgeTracer::Scratch scratch;
    const size_t begin = static_cast<size_t>(i) * kEdgesPerBlock, end = std::min(all.edges.size(), begin + kEdgesPerBlock);
    for (size_t edge = begin; edge < end; ++edge) tracer.add(edge, scratch, block);
    block.statistics.num_queries += scratch.search.num_queries;
  }, &own);
  return blocks;
}

}  // namespace echopath
