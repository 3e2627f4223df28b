#include "echopath/scene/mesh/creases.h"

#include <algorithm>
#include <map>
#include <unordered_map>

namespace echopath {
namespace {

constexpr double kSurfaceCosine = 0.5;      // of facets that are neighbours in one surface: 60 degrees
constexpr double kFlatCosine = 1.0 - 1e-6;  // of facets that are in one plane

// Holds a facet at a vertex.
struct FacetAtVertex {
  Creases::Corner at;
  Vec3 area;       // m^2, twice the area along the normal
  size_t surface;  // the facet at the vertex by which its surface is known
};
using FacetsAtVertex = std::vector<FacetAtVertex>;

bool is_within(const Vec3& a, const Vec3& b, double cosine) { return a.dot(b) >= cosine * a.norm() * b.norm(); }

// Returns the facets at those vertices where a facet is too far from the normal to be smooth. Wherever surfaces meet in a
// crease there is one: two facets that are more than 60 degrees apart cannot both be near one normal.
std::map<uint32_t, FacetsAtVertex> facets_at_creases(const std::vector<Vec3>& vertices,
                                                     const std::vector<Triangle>& triangles) {
  std::vector<Vec3> normals = sums_of_weighted_normals(vertices, triangles);
  for (Vec3& normal : normals) normal.stableNormalize();
  std::map<uint32_t, FacetsAtVertex> found;
  for (const Triangle& triangle : triangles) {
    const Vec3 area = cross_of_sides(vertices, triangle);
    const double least = kCreaseCosine * area.norm();
    for (const uint32_t vertex : triangle) {
      if (area.dot(normals[vertex]) < least) found.try_emplace(vertex);
    }
  }
  for (uint32_t t = 0; !found.empty() && t < triangles.size(); ++t) {
    for (uint32_t corner = 0; corner < 3; ++corner) {
      const auto at = found.find(triangles[t][corner]);
      if (at != found.end()) at->second.push_back({{t, corner}, cross_of_sides(vertices, triangles[t]), at->second.size()});
    }
  }
  return found;
}

size_t surface_of(FacetsAtVertex& facets, size_t facet) {
  while (facets[facet].surface != facet) facet = facets[facet].surface = facets[facets[facet].surface].surface;
  return facet;
}

// Facets with an edge in common at the vertex, and no crease between them, are one surface. An edge has two facets at most.
void find_surfaces(const std::vector<Triangle>& triangles, FacetsAtVertex& facets) {
  std::unordered_map<uint32_t, size_t> facet_at_edge;  // by the other vertex of the edge
  for (size_t i = 0; i < facets.size(); ++i) {
    for (const size_t step : {1u, 2u}) {
      const auto [triangle, corner] = facets[i].at;
      const auto [known, is_new] = facet_at_edge.try_emplace(triangles[triangle][(corner + step) % 3], i);
      if (is_new || !is_within(facets[i].area, facets[known->second].area, kSurfaceCosine)) continue;
      facets[surface_of(facets, i)].surface = surface_of(facets, known->second);
    }
  }
  for (size_t i = 0; i < facets.size(); ++i) facets[i].surface = surface_of(facets, i);
}

// Describes a surface at a vertex.
struct SurfaceAtVertex {
  size_t first;       // facet, by which it is known
  double area = 0.0;  // m^2, twice that of its facets
  bool is_flat = true;
};

std::vector<SurfaceAtVertex> surfaces_at(const FacetsAtVertex& facets) {
  std::vector<SurfaceAtVertex> surfaces;
  std::unordered_map<size_t, size_t> place;
  for (const FacetAtVertex& facet : facets) {
    const auto [at, is_new] = place.try_emplace(facet.surface, surfaces.size());
    if (is_new) surfaces.push_back({facet.surface});
    SurfaceAtVertex& surface = surfaces[at->second];
    surface.area += facet.area.norm();
    surface.is_flat = surface.is_flat && is_within(facet.area, facets[surface.first].area, kFlatCosine);
  }
  return surfaces;
}

}  // namespace

std::vector<Vec3> sums_of_weighted_normals(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles) {
  std::vector<Vec3> sums(vertices.size(), Vec3::Zero());
  for (const Triangle& triangle : triangles) {
    for (size_t i = 0; i < 3; ++i) sums[triangle[i]] += weighted_normal(vertices, triangle, i);
  }
  return sums;
}

Creases find_creases(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles) {
  Creases creases;
  for (auto& [vertex, facets] : facets_at_creases(vertices, triangles)) {
    find_surfaces(triangles, facets);
    const std::vector<SurfaceAtVertex> surfaces = surfaces_at(facets);
    const auto curved_area = [](const SurfaceAtVertex& surface) { return surface.is_flat ? 0.0 : surface.area; };
    const SurfaceAtVertex& kept = *std::ranges::max_element(surfaces, {}, curved_area);
    if (surfaces.size() == 1 || kept.is_flat) continue;
    creases.vertices.push_back(vertex);
    for (const FacetAtVertex& facet : facets) {
      if (facet.surface == kept.first) creases.corners.push_back(facet.at);
    }
    creases.first.push_back(creases.corners.size());
  }
  return creases;
}

}  // namespace echopath
