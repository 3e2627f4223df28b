#pragma once
// Says from where on an antenna sends to a material point and receives from it: contributions of nearer ones are dropped.
#include "echopath/base/lanes/simd.h"

namespace echopath {

inline constexpr double kNearAntenna = 1e-3;  // m

// Returns whether the length (m) of a leg to an antenna is long enough, of a double or of each lane of a vector.
template <class Real>
ECHOPATH_INLINE auto reaches_antenna(Real length) {
  return length >= kNearAntenna;
}

// Returns the same of the square of the length (m^2).
template <class Real>
ECHOPATH_INLINE auto reaches_antenna_by_square(Real length_squared) {
  return length_squared >= kNearAntenna * kNearAntenna;
}

}  // namespace echopath
