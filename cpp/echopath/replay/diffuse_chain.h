#pragma once
// The amplitude of a diffuse path in factors of its legs and of what lies between them (formula: amplitude.h, regime D):
//   |a| = |weight| sqrt(Pt/pi) lambda/(4 pi) * start * inner * end
//   start, end = sqrt(G |cos|)/r of the legs between the antennas and the first and the last diffuse hit,
//   inner = sqrt(prod dS/dS_trace) * prod sqrt(|cos_out cos_in|/pi)/r over the legs between diffuse hits.
// Factors carry the signs of their cosines: a surface that is seen from opposite sides makes no echo.
#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/base/simd.h"
#include "echopath/replay/amplitude.h"
#include "echopath/replay/inner_part.h"

namespace echopath {

inline constexpr double kNearAntenna = 1e-3;  // m: contributions nearer to an antenna are dropped

// root_gain: sqrt(G); cosine: signed, at the diffuse hit; length: m, from the antenna to there.
ECHOPATH_INLINE double diffuse_leg(double root_gain, double cosine, double length) {
  return length < kNearAntenna ? 0.0 : std::copysign(root_gain * std::sqrt(std::abs(cosine)) / length, cosine);
}

// The same for legs to a specular point, from which it is `to_first` (m) to the first diffuse hit.
ECHOPATH_INLINE double specular_leg(double root_gain, double length, double to_first, double root_cos_first) {
  return length < kNearAntenna ? 0.0 : root_gain * root_cos_first / (length + to_first);
}

// What lies between the first and the last material point of a path.
struct DiffuseInner {
  bool begins_specular = false;  // the first material point is none of the diffuse hits
  bool is_single = true;         // there is one diffuse hit
  double to_first = 0.0;         // m, from the first material point to the first diffuse hit
  double root_cos_first = 0.0;   // sqrt|cos_in| at the first diffuse hit with the sign of cos_in, where it begins_specular
  double factor = 1.0;
  double first_sign = 1.0, last_sign = 1.0;  // of cos_out at the first, of cos_in at the last diffuse hit of several
};
DiffuseInner diffuse_inner(const LocalPath& path, const PosedHit* hits, const InnerPart& inner);

// What is the same for all paths, sqrt(W) m.
double diffuse_scale(const RadioConstants& radio);

// One diffuse hit: its cosines must have one sign. Several: so must those of the first and those of the last hit.
ECHOPATH_INLINE double diffuse_product(double start, double end, double factor) { return std::max(0.0, start * end) * factor; }
ECHOPATH_INLINE double diffuse_product(double start, double end, double factor, double first_sign, double last_sign) {
  return std::max(0.0, start * first_sign) * std::max(0.0, end * last_sign) * factor;
}

}  // namespace echopath
