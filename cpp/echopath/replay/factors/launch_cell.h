#pragma once
// Describes the launch cell of a coherent ray: the patch of surface for which the ray stands, about as wide as rays are
// apart. It moves with its triangle. The footprint filter (cell_formula.h) is the mean of the phase factor over it; its
// second order is the quadratic phase over the cell, from ray differentials (Igehy 1999) and the curvature of the wave
// front, the receive sphere and the surface.
#include <array>

#include "echopath/replay/kernels/cell_formula.h"
#include "echopath/replay/posed/path_geometry.h"

namespace echopath {

// Describes a launch cell of the path's own stratum as it falls on the triangle of the physical-optics hit, at the trace
// time.
struct LaunchCell {
  bool is_known = false;       // else the footprint filter is off
  Eigen::Vector2d tangent[2];  // T_a in units of the triangle's edges, (du, dv) each
  // Behind a curved specular bounce, `turn` says how the direction of arrival turns across the cell, T_a.U_b in m (11, 12,
  // 22). On flat chains it follows from the length.
  bool is_curved = false;
  double turn[3] = {0.0, 0.0, 0.0};
  double facet_area = 0.0;  // m^2, PathPreparer::facet_area of its mesh
};

// Returns the cell behind a curved specular bounce from its record, Paths::curved_cell.
LaunchCell recorded_cell(const std::array<float, 7>& record);

using CellTangents = std::array<Vec3, 2>;  // T_a on the surface at the hit, world axes, m
// `hit` must have its edges.
CellTangents cell_tangents(const LaunchCell& cell, const PosedHit& hit);
CellShape cell_shape(const LaunchCell& cell, const PosedHit& hit, const CellTangents& tangents);
// Returns sqrt(|T_1 x T_2| density) of the cell as it was at the trace, in m sr^-1/2; the area of the ray tube follows from
// it. `density` is in rays per sr.
double root_area(const CellTangents& tangents, const PosedHit& hit, double density);

}  // namespace echopath
