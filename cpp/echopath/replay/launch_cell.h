#pragma once
// The patch of surface that one coherent ray stands for, carried along with its triangle, and what it does to the echo.
// Source of the second order: quadratic phase over the cell from ray differentials (Igehy 1999), curvature of wave front,
// receive sphere and surface.
#include <array>

#include "echopath/replay/cell_formula.h"
#include "echopath/replay/path_geometry.h"

namespace echopath {

// How a wave meets and leaves the physical-optics hit at one instant.
struct HitGeometry {
  const PosedHit& hit;
  Vec3 arrival, departure;          // unit directions of travel
  double length_in, length_out;     // m, unfolded: TX -> hit, hit -> RX
  double cos_in, cos_out;           // positive
};

// Tube area per launch solid angle, square root, m / sqrt(sr): the unfolded length on flat chains.
double root_tube_area(const LaunchCell& cell, const HitGeometry& geometry);

// The cell behind a curved specular bounce, from Paths::curved_cell.
LaunchCell recorded_cell(const std::array<float, 7>& record, double ray_density);

using CellTangents = std::array<Vec3, 2>;  // T_a on the surface at the hit, world axes, m
CellTangents cell_tangents(const LaunchCell& cell, const PosedHit& hit);
CellShape cell_shape(const LaunchCell& cell, const PosedHit& hit, const CellTangents& tangents);

// Footprint filter F of the cell, |F| <= 1, on curved surfaces with the taper toward their shadow (shadow_taper).
//   first order:  g_a = k T_a.(u - s)
//   second order: h_ab = k [T_a.U_b + (T_a.T_b - (T_a.s)(T_b.s))/r + (cos_in + cos_out) II(T_a, T_b)]; directions in which the
//   surface and the chain are flat keep the flat-top filter, so that plates and the axes of cylinders lose nothing.
std::complex<double> cell_filter(const LaunchCell& cell, const HitGeometry& geometry, const CellFilter& filter);

}  // namespace echopath
