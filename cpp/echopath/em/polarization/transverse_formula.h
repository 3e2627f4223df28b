#pragma once
// Computes the components of a polarisation across a direction (em/polarization/jones.h) for doubles and for vectors of
// doubles. Math is as in base/lanes/scalar_math.h.
#include "echopath/base/lanes/scalar_math.h"
#include "echopath/base/vector_of.h"

namespace echopath {

inline constexpr double kLeastSineSquared = 1e-18;  // squared sines of angles below count as 0

template <class Real>
struct TransverseOf {
  Real horizontal, vertical;
};

// Holds the axes of transverse_basis and their direction, unit vectors. `unseen` are the components of the field that an
// antenna without a null has along its polarisation: it points up, or along x of the world where the direction is that of z,
// the same for waves of both senses.
template <class Real>
struct AxesAcross {
  VectorOf<Real> direction, horizontal, vertical;
  TransverseOf<Real> unseen;
};

// `line` points along the direction and may have any length.
template <class Math, class Real>
ECHOPATH_INLINE AxesAcross<Real> axes_across(const VectorOf<Real>& line) {
  const Real level = line.x * line.x + line.y * line.y, square = level + line.z * line.z;
  const auto is_along_z = level <= kLeastSineSquared * square;
  const Real one = Real{} + 1.0, none = Real{};
  const Real inverse = 1.0 / Math::root(is_along_z ? one : level);
  const Real sense = line.z < 0.0 ? -one : one;
  const VectorOf<Real> direction = (1.0 / Math::root(square)) * line;
  const VectorOf<Real> horizontal{is_along_z ? sense : -inverse * line.y, is_along_z ? none : inverse * line.x, none};
  return {direction, horizontal, cross(direction, horizontal), {is_along_z ? sense : none, is_along_z ? none : one}};
}

// Returns the components of a polarisation across a direction (unit), scaled to length 1, along the axes of another one
// after the least rotation from that to this. So the components of antennas that see a path under slightly different
// directions belong to the same axes, wherever these point. The axes of transverse_basis at the direction itself turn about
// it all the faster the nearer it is to z, where they have no limit.
template <class Math, class Real>
ECHOPATH_INLINE TransverseOf<Real> transverse_of(const VectorOf<Real>& polarization, const VectorOf<Real>& direction,
                                                 const AxesAcross<Real>& axes) {
  constexpr double kLeast = 1e-12;  // toward the opposite direction no rotation is the least
  const Real one = Real{} + 1.0, least = Real{} + kLeast;
  const auto along_axes = [&](const VectorOf<Real>& v) {
    return VectorOf<Real>{dot(v, axes.direction), dot(v, axes.horizontal), dot(v, axes.vertical)};
  };
  const VectorOf<Real> own = along_axes(polarization), to = along_axes(direction);
  const Real taken = (dot(own, to) + own.x) / Math::larger(1.0 + to.x, least);
  const Real horizontal = own.y - taken * to.y, vertical = own.z - taken * to.z;
  const Real length_squared = horizontal * horizontal + vertical * vertical;
  const auto is_across = length_squared > kLeastSineSquared;
  const Real inverse = 1.0 / Math::root(is_across ? length_squared : one);
  return {is_across ? inverse * horizontal : axes.unseen.horizontal, is_across ? inverse * vertical : axes.unseen.vertical};
}

}  // namespace echopath
