#include "echopath/scene/mesh/manifold.h"

#include <algorithm>

#include "echopath/base/disjoint_sets.h"

namespace echopath {
namespace {

// Describes the side of triangle t from corner k to corner k + 1, numbered 3 t + k; `key` names its undirected edge.
struct Side {
  uint64_t key;
  uint32_t id;
  bool ascending;  // runs from the smaller to the larger vertex
};

std::vector<Side> sorted_sides(const std::vector<Triangle>& triangles) {
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (uint32_t t = 0; t < triangles.size(); ++t) {
    for (uint32_t k = 0; k < 3; ++k) {
      const uint64_t from = triangles[t][k], to = triangles[t][(k + 1) % 3];
      sides.push_back({std::min(from, to) << 32 | std::max(from, to), 3 * t + k, from < to});
    }
  }
  std::ranges::sort(sides, [](const Side& a, const Side& b) { return a.key != b.key ? a.key < b.key : a.id < b.id; });
  return sides;
}

// Calls visit(first, last) for each undirected edge with the range of its sides, in order of triangles.
template <class Visit>
void for_each_edge(const std::vector<Side>& sides, Visit visit) {
  for (auto first = sides.begin(); first != sides.end();) {
    auto last = first;
    while (last != sides.end() && last->key == first->key) ++last;
    visit(first, last);
    first = last;
  }
}

uint32_t next_corner(uint32_t side) { return side % 3 == 2 ? side - 2 : side + 1; }

// Joins the corners of one vertex that are connected through manifold edges.
DisjointSets fans(const std::vector<Triangle>& triangles, const std::vector<Side>& sides) {
  DisjointSets corners(3 * triangles.size());
  for_each_edge(sides, [&](auto first, auto last) {
    if (last - first != 2 || first[0].ascending == first[1].ascending) return;
    corners.join(first[0].id, next_corner(first[1].id));
    corners.join(next_corner(first[0].id), first[1].id);
  });
  return corners;
}

// The first fan of a vertex keeps its number, each other one gets a copy.
void split_fans(std::vector<Triangle>& triangles, DisjointSets& corners, std::vector<uint32_t>& original_vertex) {
  constexpr uint32_t kNone = 0xffffffffu;
  std::vector<uint32_t> vertex_of_fan(3 * triangles.size(), kNone);
  std::vector<bool> taken(original_vertex.size(), false);
  for (uint32_t corner = 0; corner < vertex_of_fan.size(); ++corner) {
    uint32_t& vertex = triangles[corner / 3][corner % 3];
    uint32_t& assigned = vertex_of_fan[corners.find(corner)];
    if (assigned == kNone) {
      assigned = vertex;
      if (taken[vertex]) {
        assigned = static_cast<uint32_t>(original_vertex.size());
        const uint32_t origin = original_vertex[vertex];
        original_vertex.push_back(origin);
      } else {
        taken[vertex] = true;
      }
    }
    vertex = assigned;
  }
}

}  // namespace

// No further pass is needed: a fan is open at two sides at most, one running towards its vertex and one away from it,
// and all its other sides are glued in pairs, so no two faces run through an edge of the new numbers in the same
// direction.
void cut_to_manifold(std::vector<Triangle>& triangles, std::vector<uint32_t>& original_vertex) {
  DisjointSets corners = fans(triangles, sorted_sides(triangles));
  split_fans(triangles, corners, original_vertex);
}

}  // namespace echopath
