#include "echopath/scene/mesh/adjacency.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace echopath {
namespace {

struct Edge {
  uint32_t low, high;  // numbers of the places of both ends
  uint32_t triangle;
  uint32_t side;  // of the triangle
  bool meets(const Edge& other) const { return low == other.low && high == other.high; }
};

// Numbers the places of the vertices: vertices at the same place get the same number.
std::vector<uint32_t> places_of(const std::vector<Vec3>& vertices) {
  const auto before = [&](uint32_t a, uint32_t b) {
    const Vec3 &p = vertices[a], &q = vertices[b];
    return std::lexicographical_compare(p.data(), p.data() + 3, q.data(), q.data() + 3);
  };
  std::vector<uint32_t> order(vertices.size()), place(vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(order, before);
  for (size_t i = 0; i < order.size(); ++i) {
    const bool is_same = i > 0 && vertices[order[i]] == vertices[order[i - 1]];
    place[order[i]] = is_same ? place[order[i - 1]] : static_cast<uint32_t>(i);
  }
  return place;
}

std::vector<Edge> sorted_edges(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles) {
  const std::vector<uint32_t> place = places_of(vertices);
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.size());
  for (uint32_t t = 0; t < triangles.size(); ++t) {
    for (uint32_t side = 0; side < 3; ++side) {
      const auto [low, high] = std::minmax(place[triangles[t][side]], place[triangles[t][(side + 1) % 3]]);
      edges.push_back({low, high, t, side});
    }
  }
  std::ranges::sort(edges, [](const Edge& a, const Edge& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  return edges;
}

}  // namespace

std::vector<std::array<uint32_t, 3>> edge_neighbours(const std::vector<Vec3>& vertices,
                                                     const std::vector<Triangle>& triangles) {
  std::vector<std::array<uint32_t, 3>> neighbours(triangles.size(), {kNoTriangle, kNoTriangle, kNoTriangle});
  const std::vector<Edge> edges = sorted_edges(vertices, triangles);
  for (size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end].meets(edges[begin])) ++end;
    if (end - begin != 2) continue;
    const Edge &first = edges[begin], &second = edges[begin + 1];
    neighbours[first.triangle][first.side] = second.triangle;
    neighbours[second.triangle][second.side] = first.triangle;
  }
  return neighbours;
}

}  // namespace echopath
