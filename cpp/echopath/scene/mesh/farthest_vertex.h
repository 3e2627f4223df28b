#pragma once
// Says how far away vertices of a mesh may be in coordinates of its own. Internal to the module.
#include "echopath/base/geometry.h"

namespace echopath {

inline constexpr double kFarthestVertex = 1e70;  // m; areas beyond it have no double

inline bool is_vertex_in_range(const Vec3& vertex) { return (vertex.array().abs() <= kFarthestVertex).all(); }  // NaN is not

}  // namespace echopath
