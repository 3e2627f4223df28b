#include "echopath/trace/edges/edge_paths.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/base/parallel.h"
#include "echopath/trace/edges/posed_edge.h"
#include "echopath/trace/mirrors/legs.h"
#include "echopath/trace/near_antenna.h"

namespace echopath {
namespace {

constexpr size_t kEdgesPerBlock = 64;
constexpr double kFlatFront = 0.1;    // rad, of the wave fronts over half a piece
constexpr double kOfMesh = 1.0 / 16;  // of the mesh's extent, a piece at most

struct EdgeOfMesh {
  uint32_t mesh_id;
  SharpEdge edge;
};

bool reflects_like_a_conductor(const Material& material) { return material.conductor || material.reflectivity.has_value(); }

AntennaView view_for_edges(const Vec3& antenna, const MirrorFrusta& found, const EdgeQuery& query) {
  if (!query.frusta.serve_legs) return {antenna, {}, {}};
  return view_of(antenna, with_at_most(found, most_leg_mirrors(query.settings)));
}

class EdgeTracer {
 public:
  explicit EdgeTracer(const EdgeQuery& query)
      : query_(query), finder_(query.geometry, query.mirrors, query.settings.frequency, query.settings.polarization),
        transmitter_(view_for_edges(query.settings.transmitter, query.frusta.transmitter, query)),
        receiver_(view_for_edges(query.settings.receiver, query.frusta.receiver, query)) {}

  // Holds what is needed while one thread follows edges.
  struct Scratch {
    std::vector<Leg> in, out;
    LegSearch search;
  };

  void add(const EdgeOfMesh& one, Scratch& scratch, PathBlock& block) const {
    const SharpEdge& edge = one.edge;
    const auto corners = query_.geometry.corners(one.mesh_id, edge.triangle);
    const Vec3 &from = corners[edge.side], &to = corners[(edge.side + 1) % 3];
    const Wedge wedge = posed_wedge(edge, query_.pose, one.mesh_id);
    const int num_pieces = pieces_of(from + edge.begin * (to - from), from + edge.end * (to - from), one.mesh_id);
    for (int piece = 0; piece < num_pieces; ++piece) {
      const double along = edge.begin + (edge.end - edge.begin) * (piece + 0.5) / num_pieces;
      const PointOnSide at = point_on_side(edge.side, along);
      const Vec3 point = corners[0] + double{at.u} * (corners[1] - corners[0]) + double{at.v} * (corners[2] - corners[0]);
      add_point({one.mesh_id, edge.triangle, at.u, at.v}, point, wedge, num_pieces, scratch, block);
    }
  }

 private:
  int pieces_of(const Vec3& from, const Vec3& to, uint32_t mesh_id) const {
    const double wavenumber = kTwoPi * query_.settings.frequency / kSpeedOfLight, length = (to - from).norm();
    const auto inverse = [&](const Vec3& antenna) {
      return 1.0 / std::max(distance_to_segment(antenna, from, to), kNearAntenna);
    };
    const double bend = wavenumber * (inverse(query_.settings.transmitter) + inverse(query_.settings.receiver));
    const double extent = query_.geometry.box(mesh_id).diagonal().norm();
    const double piece = std::min(std::sqrt(8.0 * kFlatFront / bend), kOfMesh * extent);
    return static_cast<int>(std::clamp(std::ceil(length / piece), 1.0, double{kMostPieces}));
  }

  // Finds the legs from a point to an antenna that leave into the space around the edge.
  void find_legs(const Vec3& point, const Wedge& wedge, const AntennaView& antenna, int max_mirrors, std::vector<Leg>& legs,
                 LegSearch& search) const {
    LegQuery query{point, outward_of(wedge), max_mirrors};
    query.faces_all = true;
    finder_.find(query, antenna, legs, search);
    std::erase_if(legs, [&](const Leg& leg) { return leg.length < kNearAntenna || !is_outside(wedge, leg.to_antenna); });
  }

  void add_point(const Hit& hit, const Vec3& point, const Wedge& wedge, int num_pieces, Scratch& scratch,
                 PathBlock& block) const {
    const int max_mirrors = std::min(query_.settings.max_bounces - 1, most_leg_mirrors(query_.settings));
    find_legs(point, wedge, receiver_, max_mirrors, scratch.out, scratch.search);
    ++block.statistics.num_hits;
    if (scratch.out.empty()) return;
    find_legs(point, wedge, transmitter_, max_mirrors, scratch.in, scratch.search);
    for (const Leg& in : scratch.in) {
      for (const Leg& out : scratch.out) {
        if (in.num_bounces + 1 + out.num_bounces <= query_.settings.max_bounces)
          add_path(in, hit, out, wedge, num_pieces, block);
      }
    }
  }

  // Returns the share of a field that the faces keep in phase: as they would mirror it, the one that faces it more.
  double share_of(const Leg& in, const Wedge& wedge, uint32_t mesh_id) const {
    const double cos_in = std::max(in.to_antenna.dot(wedge.faces[0].normal), in.to_antenna.dot(wedge.faces[1].normal));
    const SurfaceResponse response = respond(*query_.scene.node_of(mesh_id).material, query_.settings.frequency,
                                             std::clamp(cos_in, 0.0, 1.0), PolarizationMode::kTe);
    return std::abs(response.gamma) * response.coherent;
  }

  void add_path(const Leg& in, const Hit& hit, const Leg& out, const Wedge& wedge, int num_pieces, PathBlock& block) const {
    std::array<Hit, 2 * kMaxLegMirrors + 1> hits;
    int count = 0;
    for (int k = in.num_bounces; k-- > 0;) hits[static_cast<size_t>(count++)] = in.bounces[static_cast<size_t>(k)].hit;
    const int at = count;
    hits[static_cast<size_t>(count++)] = hit;
    for (int k = 0; k < out.num_bounces; ++k) hits[static_cast<size_t>(count++)] = out.bounces[static_cast<size_t>(k)].hit;
    const std::complex<double> over_mirrors = query_.settings.is_polarized ? 1.0 : in.gain * out.gain;
    const std::complex<double> weight = share_of(in, wedge, hit.mesh_id) * over_mirrors;
    block.add(hits.data(), count, 0, std::complex<float>(weight), kNoStratum);
    block.set_edge(at, num_pieces);
    if (query_.settings.is_polarized) block.set_jones({1.0f, 0.0f, 0.0f, 1.0f});
  }

  const EdgeQuery& query_;
  LegFinder finder_;
  AntennaView transmitter_, receiver_;
};

std::vector<EdgeOfMesh> all_edges(const Scene& scene) {
  std::vector<EdgeOfMesh> all;
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) {
    for (const SharpEdge& edge : echoing_edges(scene, id)) all.push_back({id, edge});
  }
  return all;
}

}  // namespace

std::vector<SharpEdge> echoing_edges(const Scene& scene, uint32_t mesh_id) {
  const Node& node = scene.node_of(mesh_id);
  const bool makes_echoes = reflects_like_a_conductor(*node.material) && !node.material->mirror;
  if (!makes_echoes || node.deformation || scene.may_stretch(mesh_id)) return {};
  return node.mesh->sharp_edges();
}

std::vector<PathBlock> find_edge_paths(const EdgeQuery& query, Job* job) {
  const std::vector<EdgeOfMesh> edges = all_edges(query.scene);
  const EdgeTracer tracer(query);
  std::vector<PathBlock> blocks((edges.size() + kEdgesPerBlock - 1) / kEdgesPerBlock);
  Job own(job);
  parallel_for(std::ssize(blocks), [&](int64_t i) {
    PathBlock& block = blocks[static_cast<size_t>(i)];
    EdgeTracer::Scratch scratch;
    const size_t begin = static_cast<size_t>(i) * kEdgesPerBlock, end = std::min(edges.size(), begin + kEdgesPerBlock);
    for (size_t k = begin; k < end; ++k) tracer.add(edges[k], scratch, block);
    block.statistics.num_queries += scratch.search.num_queries;
  }, &own);
  return blocks;
}

}  // namespace echopath
