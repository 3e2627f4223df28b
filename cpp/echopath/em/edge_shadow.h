#pragma once
// Computes what an edge makes of the wave that goes by it, beside what its faces reflect.
//
// The field about a wedge is that of geometrical optics with a transition at the boundary of shadow and one at that of
// reflection. Here is the first: the field that an edge takes from the lit side of the boundary of shadow and adds on the
// other side. Source: Kouyoumjian and Pathak 1974 (uniform theory of diffraction).
#include <Eigen/Core>

#include "echopath/em/edge_diffraction.h"

namespace echopath {

// Returns the matrix M of this part, with which it counts as fringe_matrix does. `phase` is k s s'/(s + s') in rad, with the
// lengths s' before the edge and s behind it over which the transition develops. M is zero inside of the wedge and within 1e-3
// rad of the edge's own direction.
Eigen::Matrix3cd past_edge_matrix(const Wedge& wedge, const Vec3& in, const Vec3& out, double phase);

}  // namespace echopath
