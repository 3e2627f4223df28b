#include "echopath/trace/edges/edge_paths.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/trace/connect/antenna_legs.h"
#include "echopath/trace/edges/edge_coefficients.h"
#include "echopath/trace/edges/edge_sequences.h"

namespace echopath {
namespace {

constexpr int64_t kEdgesPerBlock = 64;
constexpr double kFrontPhase = 0.8;        // rad, quadratic phase over half a piece: as much as edge_filter follows
constexpr double kOfBody = 1.0 / 16;       // of the extent of a body, a piece at most where a part of the edge is hidden
constexpr double kLeastDiffracted = 0.03;  // of what the edge of a half plane sends

// Returns the extent (m) of the body that each mesh belongs to, by mesh ID.
std::vector<double> extents_of_bodies(const EdgeQuery& query) {
  const SceneEdges found(query.scene);
  std::vector<Box> box(query.scene.meshes().size());
  for (uint32_t id = 0; id < box.size(); ++id) {
    if (!found.of(id).empty()) box[found.body_of(id)].extend(query.geometry.box(id));
  }
  std::vector<double> extent;
  for (uint32_t id = 0; id < box.size(); ++id) {
    const Box& body = box[found.body_of(id)];
    extent.push_back(body.isEmpty() ? 0.0 : body.diagonal().norm());
  }
  return extent;
}

EdgeLeg edge_leg_of(const Leg& leg) { return {leg.to_antenna, leg.at_antenna, leg.length}; }

template <class Coefficients>
class EdgeTracer {
 public:
  explicit EdgeTracer(const EdgeQuery& query)
      : query_(query), coefficients_(query.settings.polarization), extent_(extents_of_bodies(query)),
        wavenumber_(kTwoPi * query.settings.frequency / kSpeedOfLight), sequences_(query.edges, kTwoPi / wavenumber_),
        finder_(query.geometry, query.mirrors, query.settings.frequency, query.settings.polarization),
        transmitter_(
            view_for_legs(query.settings.transmitter, query.frusta.transmitter, query.frusta.serve_legs, query.settings)),
        receiver_(view_for_legs(query.settings.receiver, query.frusta.receiver, query.frusta.serve_legs, query.settings)) {}

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
    const PosedEdge& one = query_.edges[edge];
    const double longest =
        longest_piece(one, query_.settings.transmitter, query_.settings.receiver, wavenumber_, kFrontPhase);
    set_pieces(one, std::min(longest, kOfBody * extent_[one.mesh_id]), scratch);
    look(one.wedge, query_.settings.transmitter, scratch, scratch.to_transmitter);
    look(one.wedge, query_.settings.receiver, scratch, scratch.to_receiver);
    const auto is_open = [](ShadowState state) { return state == ShadowState::kOpen; };
    if (std::ranges::all_of(scratch.to_transmitter, is_open) && std::ranges::all_of(scratch.to_receiver, is_open))
      set_pieces(one, longest, scratch);
    for (size_t piece = 0; piece < scratch.points.size(); ++piece) add_point(edge, piece, scratch, block);
  }

 private:
  void set_pieces(const PosedEdge& one, double longest, Scratch& scratch) const {
    const auto corners = query_.geometry.corners(one.mesh_id, one.edge.triangle);
    const auto num_pieces = static_cast<int>(std::clamp(std::ceil(one.line().norm() / longest), 1.0, double{kMostPieces}));
    scratch.hits.clear();
    scratch.points.clear();
    for (int piece = 0; piece < num_pieces; ++piece) {
      const EdgePoint at = point_on_edge(one, (piece + 0.5) / num_pieces, corners);
      scratch.hits.push_back(at.hit);
      scratch.points.push_back(at.position);
    }
  }

  // Looks from all pieces to an antenna at once.
  void look(const Wedge& wedge, const Vec3& antenna, Scratch& scratch, std::vector<ShadowState>& states) const {
    const Vec3 outward = outward_of(wedge);
    states.assign(scratch.points.size(), ShadowState::kBlocked);
    scratch.segments.clear();
    for (size_t i = 0; i < scratch.points.size(); ++i) {
      const Vec3 line = antenna - scratch.points[i];
      if (!may_leave(wedge, line, line.norm())) continue;
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
    std::erase_if(legs, [&](const Leg& leg) { return !may_leave(wedge, leg.to_antenna, leg.length); });
  }

  void add_point(size_t edge, size_t piece, Scratch& scratch, PathBlock& block) const {
    const Wedge& wedge = query_.edges[edge].wedge;
    const Vec3& point = scratch.points[piece];
    ++block.statistics.num_hits;
    find_legs(point, wedge, transmitter_, scratch.to_transmitter[piece], scratch.in, scratch.search);
    if (scratch.in.empty()) return;
    find_legs(point, wedge, receiver_, scratch.to_receiver[piece], scratch.out, scratch.search);
    const std::span<const Hit> hit(&scratch.hits[piece], 1);
    const int num_pieces = static_cast<int>(scratch.points.size());
    for (const Leg& in : scratch.in) {
      for (const Leg& out : scratch.out) {
        const auto coupled = [&] { return fringe_matrix(wedge, -in.to_antenna, out.to_antenna).norm(); };
        if (is_strong(wedge, edge_leg_of(in), edge_leg_of(out), coefficients_.held(in.gain * out.gain), coupled))
          add_path(in, hit, out, wedge, num_pieces, block);
      }
      const auto add_sequence = [&](const EdgeSequence& sequence, size_t last) {
        return add_multiple(in, sequence, last, num_pieces, scratch, block);
      };
      const int most = std::min(kMostEdges, query_.settings.max_bounces - in.num_bounces);
      sequences_.follow(edge, scratch.hits[piece], point, -in.to_antenna, most, add_sequence);
    }
  }

  // Adds the paths that end with the last edge of a sequence; returns whether the wave there is strong enough to go on.
  bool add_multiple(const Leg& in, const EdgeSequence& sequence, size_t last, int num_pieces, Scratch& scratch,
                    PathBlock& block) const {
    const std::optional<MultipleDiffraction> multiple = MultipleDiffraction::over(sequence.edges, wavenumber_);
    if (!multiple) return false;
    const double entered = strength(*multiple, in);
    const Wedge& wedge = query_.edges[last].wedge;
    const Vec3 point = sequence.edges.back().point, line = query_.settings.receiver - point;
    const bool is_lit = may_leave(wedge, line, line.norm());
    const bool is_seen = is_lit && matters(*multiple, entered, line.normalized(), line.norm());
    const bool goes_on = entered > kLeastDiffracted;
    if (!is_seen && (receiver_.frusta.empty() || !goes_on)) return goes_on;
    find_legs(point, wedge, receiver_, is_seen ? ShadowState::kUnknown : ShadowState::kBlocked, scratch.behind,
              scratch.search);
    for (const Leg& out : scratch.behind) {
      const auto coupled = [&] { return entered * multiple->leave(out.to_antenna, out.length).norm(); };
      const EdgeLeg arrival{-multiple->arrival(), in.at_antenna, in.length};
      if (matters(*multiple, entered, out.to_antenna, out.length) &&
          is_strong(wedge, arrival, edge_leg_of(out), coefficients_.held(in.gain * out.gain), coupled))
        add_path(in, sequence.hits, out, wedge, num_pieces, block);
    }
    return goes_on;
  }

  // Returns whether an echo is to be kept; `coupled` returns the norm of what the edge makes of the field.
  template <class Coupled>
  bool is_strong(const Wedge& wedge, const EdgeLeg& in, const EdgeLeg& out, std::complex<double> over_mirrors,
                 const Coupled& coupled) const {
    return query_.least_power == 0.0 ||
           query_.estimate.power(wedge, in, out, std::abs(over_mirrors) * coupled()) >= query_.least_power;
  }

  // Returns the strength on the last face.
  double strength(const MultipleDiffraction& multiple, const Leg& leg) const {
    const Vec3 in = -leg.to_antenna;
    const FieldVector row = multiple.enter(in, leg.length);
    return coefficients_.strongest(in, [&](const Vec3& field) { return std::abs(row.dot(field)); });
  }

  // Returns whether multiple diffraction sends at least kLeastDiffracted of the edge of a half plane, likewise.
  bool matters(const MultipleDiffraction& multiple, double entered, const Vec3& out, double distance) const {
    constexpr double kOfHalfPlane = 2.0;
    // What leaves an edge is largest about the direction of the wave.
    const double most = 4.0 * std::sqrt(2.0 / std::max(1.0 - multiple.arrival().dot(out), 1e-12));
    if (entered * most < kOfHalfPlane * kLeastDiffracted) return false;
    const FieldVector left = multiple.leave(out, distance);
    return entered * coefficients_.received(out, left) > kOfHalfPlane * kLeastDiffracted;
  }

  // `wedge` is that of the last edge; the share of the field that stays in phase is taken from it.
  void add_path(const Leg& in, std::span<const Hit> on_edges, const Leg& out, const Wedge& wedge, int num_pieces,
                PathBlock& block) const {
    if (in.num_bounces + std::ssize(on_edges) + out.num_bounces > query_.settings.max_bounces) return;
    std::array<Hit, 2 * kMaxLegMirrors + kMostEdges> hits;
    int count = 0;
    for (int k = in.num_bounces; k-- > 0;) hits[count++] = in.bounces[k].hit;
    const int at = count;
    for (const Hit& hit : on_edges) hits[count++] = hit;
    for (int k = 0; k < out.num_bounces; ++k) hits[count++] = out.bounces[k].hit;
    const Material& material = *query_.scene.node_of(on_edges.back().mesh_id).material;
    const double kept = kept_share(material, query_.settings.frequency, wedge, in.to_antenna);
    const std::complex<double> weight = kept * coefficients_.held(in.gain * out.gain);
    block.add(hits.data(), count, 0, std::complex<float>(weight), kNoStratum);
    block.set_edge(at, num_pieces, static_cast<int>(on_edges.size()));
    coefficients_.add_matrix(block);
  }

  const EdgeQuery& query_;
  Coefficients coefficients_;
  std::vector<double> extent_;  // m, by mesh ID
  double wavenumber_;           // rad/m
  EdgeSequences sequences_;
  LegFinder finder_;
  AntennaView transmitter_, receiver_;
};

template <class Coefficients>
std::vector<PathBlock> edge_paths(const EdgeQuery& query, Job* job) {
  const EdgeTracer<Coefficients> tracer(query);
  const int64_t num_edges = std::ssize(query.edges);
  std::vector<PathBlock> blocks(num_chunks(num_edges, kEdgesPerBlock));
  Job own(job);
  parallel_for_chunks(num_edges, kEdgesPerBlock, [&](int64_t begin, int64_t end) {
    PathBlock& block = blocks[begin / kEdgesPerBlock];
    typename EdgeTracer<Coefficients>::Scratch scratch;
    for (int64_t edge = begin; edge < end; ++edge) tracer.add(edge, scratch, block);
    block.statistics.num_queries += scratch.search.num_queries;
  }, &own);
  return blocks;
}

}  // namespace

std::vector<PathBlock> find_edge_paths(const EdgeQuery& query, Job* job) {
  if (query.settings.is_polarized) return edge_paths<JonesCoefficients>(query, job);
  return edge_paths<ScalarCoefficients>(query, job);
}

}  // namespace echopath
