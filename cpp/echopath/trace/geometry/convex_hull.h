#pragma once
// Finds convex hulls of points of a plane.
#include <Eigen/Core>
#include <vector>

namespace echopath {

using PlanePoints = std::vector<Eigen::Vector2d>;

// Returns the corners of the hull in order around it, counterclockwise (Andrew 1979). Fewer than three distinct points come
// back as they are, each once.
PlanePoints convex_hull(PlanePoints points);

}  // namespace echopath
