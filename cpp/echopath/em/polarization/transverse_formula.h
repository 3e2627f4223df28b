#pragma once
// Computes the components of a polarisation across a direction (em/polarization/jones.h) for doubles and for vectors of
// doubles. Math is as in base/lanes/scalar_math.h.
#include "echopath/base/lanes/scalar_math.h"
#include "echopath/base/vector_of.h"

namespace echopath {

template <class Real>
struct TransverseOf {
  Real horizontal, vertical;
};

// Returns the components along the axes of transverse_basis, scaled to length 1. `line` points along the direction and may
// have any length. Gain patterns hold the nulls of antennas, so that an isotropic one has none along its polarisation
// either: there its field points up, or along x of the world where the direction is that of z, the same for waves of both
// senses.
template <class Math, class Real>
ECHOPATH_INLINE TransverseOf<Real> transverse_of(const VectorOf<Real>& polarization, const VectorOf<Real>& line) {
  constexpr double kLeast = 1e-18;  // squares of sines below count as 0
  const Real level = line.x * line.x + line.y * line.y, square = level + line.z * line.z;
  const auto is_along_z = level <= kLeast * square;
  const Real off_axis = Math::root(square) * (polarization.y * line.x - polarization.x * line.y);
  const Real upward = polarization.z * level - line.z * (polarization.x * line.x + polarization.y * line.y);
  const Real horizontal = is_along_z ? (line.z < 0.0 ? -polarization.x : polarization.x) : off_axis;
  const Real vertical = is_along_z ? polarization.y : upward;
  const Real one = Real{} + 1.0, none = Real{};
  const Real length_squared = horizontal * horizontal + vertical * vertical, scale = is_along_z ? one : level * square;
  const auto is_across = length_squared > kLeast * scale;
  const Real inverse = 1.0 / Math::root(is_across ? length_squared : one);
  const Real horizontal_alone = is_along_z ? (line.z < 0.0 ? -one : one) : none, vertical_alone = is_along_z ? none : one;
  return {is_across ? inverse * horizontal : horizontal_alone, is_across ? inverse * vertical : vertical_alone};
}

}  // namespace echopath
