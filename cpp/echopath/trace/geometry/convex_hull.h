#pragma once
// Convex hulls of points of a plane.
#include <Eigen/Core>
#include <vector>

namespace echopath {

using PlanePoints = std::vector<Eigen::Vector2d>;

// Corners in order around it, counterclockwise (Andrew 1979). Points that are fewer than three, or the same, come back as
// they are, each once.
PlanePoints convex_hull(PlanePoints points);

}  // namespace echopath
