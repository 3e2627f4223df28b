#pragma once
// Computes what an edge adds to the waves of geometrical optics that go by it and that its faces reflect.
//
// This is the field of the uniform theory of diffraction: it goes on from the lit side of the boundaries of shadow and of
// reflection to the dark one. Physical optics and its fringe (edge_diffraction.h) describe the same edge, but as currents on
// the face that a plane mirror beyond the edge does not see whole. Source: Kouyoumjian and Pathak 1974.
#include <Eigen/Core>

#include "echopath/em/edges/edge_diffraction.h"

namespace echopath {

// Returns the matrix M of the edge, with which it counts as fringe_matrix does. `phase` is k s s'/(s + s') in rad, with the
// lengths s' before the edge and s behind it over which the transitions develop. The field has no sign at a boundary of
// reflection, where what the faces reflect ends: within half a Fresnel zone of it that part fades to zero. M is zero inside
// of the wedge and within 1e-3 rad of the edge's own direction.
Eigen::Matrix3cd diffraction_matrix(const Wedge& wedge, const Vec3& in, const Vec3& out, double phase);

}  // namespace echopath
