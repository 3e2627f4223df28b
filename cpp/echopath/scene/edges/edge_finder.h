#pragma once
// Finds sharp edges of one surface, or of several that touch, by where the sides of their triangles lie.
#include <span>
#include <vector>

#include "echopath/scene/edges/sharp_edges.h"

namespace echopath {

// Describes a surface in the frame in which edges are looked for.
struct EdgeSurface {
  const Mesh* mesh;
  Transform place;            // from the mesh's frame
  std::vector<Box> contacts;  // where others may touch it; empty for one surface alone

  // Returns whether a side between two points may lie on another surface.
  bool may_touch(const Vec3& from, const Vec3& to) const {
    Box side(from.cwiseMin(to), from.cwiseMax(to));
    const auto meets = [&](const Box& contact) { return contact.intersects(side); };
    return contacts.empty() || std::ranges::any_of(contacts, meets);
  }
};

struct FoundEdge {
  uint32_t surface;
  SharpEdge edge;  // in the common frame
};

// Names a stretch of a side.
struct SideStretch {
  uint32_t surface, triangle, side;
  double begin, end;
};
// Holds the sides of several surfaces that lie on each other along one stretch, sharp or not.
using Seam = std::vector<SideStretch>;

struct FoundEdges {
  std::vector<FoundEdge> edges;  // ascending by surface, triangle, side and begin
  std::vector<Seam> seams;
};

// Returns the edges of one surface (find_sharp_edges); of several surfaces, those along which at least two of them meet, and
// all seams. Of several triangles at one edge, that of the first surface with the least index has it.
FoundEdges find_edges(std::span<const EdgeSurface> surfaces);

}  // namespace echopath
