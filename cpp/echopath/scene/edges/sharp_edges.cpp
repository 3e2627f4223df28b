#include "echopath/scene/edges/sharp_edges.h"

#include <algorithm>
#include <map>

#include "echopath/scene/edges/edge_finder.h"

namespace echopath {
namespace {

// Returns those on the triangles of a part, with their numbers in it.
std::vector<SharpEdge> edges_of_part(const std::vector<SharpEdge>& whole, const std::vector<uint32_t>& whole_triangle) {
  std::map<uint32_t, uint32_t> place;
  for (uint32_t t = 0; t < whole_triangle.size(); ++t) place[whole_triangle[t]] = t;
  std::vector<SharpEdge> edges;
  for (SharpEdge edge : whole) {
    const auto found = place.find(edge.triangle);
    if (found == place.end()) continue;
    edge.triangle = found->second;
    edges.push_back(edge);
  }
  return edges;
}

}  // namespace

std::vector<SharpEdge> find_sharp_edges(const Mesh& mesh) {
  const EdgeSurface surface{&mesh.surface(), Transform::Identity(), {}};
  std::vector<SharpEdge> edges;
  for (const FoundEdge& found : find_edges({&surface, 1}).edges) edges.push_back(found.edge);
  return mesh.whole() ? edges_of_part(edges, mesh.whole_triangle()) : edges;
}

const SharpEdge* sharp_edge_at(std::span<const SharpEdge> edges, uint32_t triangle, double u, double v) {
  if (u != 0.0 && v != 0.0 && u + v != 1.0) return nullptr;
  const uint32_t side = v == 0.0 ? 0 : u == 0.0 ? 2 : 1;
  const double along = side == 0 ? u : side == 1 ? v : 1.0 - v;
  auto edge = std::ranges::lower_bound(edges, triangle, {}, &SharpEdge::triangle);
  for (; edge != edges.end() && edge->triangle == triangle; ++edge) {
    if (edge->side == side && edge->begin <= along && along <= edge->end) return &*edge;
  }
  return nullptr;
}

// The larger coordinate of the two that make 1 is rounded first; the other one then follows without rounding.
PointOnSide point_on_side(uint32_t side, double along) {
  if (side == 0) return {static_cast<float>(along), 0.0f};
  if (side == 2) return {0.0f, static_cast<float>(1.0 - along)};
  if (along >= 0.5) {
    const auto v = static_cast<float>(along);
    return {1.0f - v, v};
  }
  const auto u = static_cast<float>(1.0 - along);
  return {u, 1.0f - u};
}

}  // namespace echopath
