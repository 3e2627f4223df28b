#pragma once
// Wedges and directions about their edges.
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/em/edges/edge_diffraction.h"

namespace echopath::testing {

// The edge lies along z. Angles about it count from the first face, which lies along x and looks along y.
inline Vec3 across(double angle) { return {std::cos(angle), std::sin(angle), 0.0}; }
inline Vec3 direction(double angle, double cosine) {
  const Vec3 out = std::sqrt(1.0 - cosine * cosine) * across(angle);
  return {out[0], out[1], cosine};
}
inline Wedge wedge_of(double exterior) {
  return {{{across(0.0), across(0.5 * kPi)}, {across(exterior), across(exterior - 0.5 * kPi)}}, exterior};
}

}  // namespace echopath::testing
