#pragma once
// Leaves out points that no outline of a body depends on.
#include <vector>

#include "echopath/base/geometry.h"

namespace echopath {

// Returns, in their order, the points that may be corners of the convex hull. Left out are those within the polytope of the
// outermost ones in 26 directions, and those outside of it by less than a millionth of their distance from its middle, as on
// its faces by rounding: of a box all but its corners, whichever way it is turned.
std::vector<Vec3> outer_points_of_hull(const std::vector<Vec3>& points);

}  // namespace echopath
