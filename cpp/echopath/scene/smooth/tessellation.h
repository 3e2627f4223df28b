#pragma once
// Measures how the triangles of a mesh approximate a curved surface.
#include <optional>

#include "echopath/scene/mesh/mesh.h"

namespace echopath {

struct Tessellation {
  double edge = 0.0;         // m, of an equilateral triangle that strays as far from the surface (for strips their width)
  double radius = 0.0;       // m, of curvature, where the triangle strays; both are medians over the curved area
  double curved_area = 0.0;  // m^2, of the curved facets
  double area = 0.0;         // m^2, of all
};

// Measures the curvature that the facets stand for, from the turns between neighbours. Returns nothing for meshes without
// curved surfaces: planes, and planes that meet in edges of more than 40 degrees or in single bends. Pieces that no edge
// holds together, as a body and the road below it in one mesh, are looked at one by one; the figures are of all that are
// curved. Each edge contributes its turn across it to the curvature tensor of both facets (Cohen-Steiner and Morvan 2003);
// the mean depth of the surface over a facet is that tensor times the facet's second moments.
std::optional<Tessellation> tessellation_of(const Mesh& mesh);

}  // namespace echopath
