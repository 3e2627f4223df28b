#pragma once
// Turns vectors of the linear algebra into those that formulas for single values and for lanes take, and back.
#include "echopath/base/geometry.h"
#include "echopath/base/vector_of.h"

namespace echopath {

ECHOPATH_INLINE VectorOf<double> unpacked(const Vec3& v) { return {v[0], v[1], v[2]}; }
ECHOPATH_INLINE Vec3 packed(const VectorOf<double>& v) { return {v.x, v.y, v.z}; }

}  // namespace echopath
