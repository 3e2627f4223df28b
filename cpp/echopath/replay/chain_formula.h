#pragma once
// The amplitude of a diffuse path in factors of its legs and of what lies between them (formula: amplitude.h, regime D):
//   |a| = |weight| sqrt(Pt/pi) lambda/(4 pi) * start * inner * end
//   start, end = sqrt(G |cos|)/r of the legs between the antennas and the first and the last diffuse hit,
//   inner = sqrt(prod dS/dS_trace) * prod sqrt(|cos_out cos_in|/pi)/r over the legs between diffuse hits.
// Factors carry the signs of their cosines: a surface that is seen from opposite sides makes no echo. For doubles and for vectors
// of doubles: Math as in base/scalar_math.h.
#include "echopath/base/scalar_math.h"
#include "echopath/trace/near_antenna.h"

namespace echopath {

// root_gain: sqrt(G); cosine: signed, at the diffuse hit; length: m, from the antenna to there.
template <class Math, class Real>
ECHOPATH_INLINE Real diffuse_leg(Real root_gain, Real cosine, Real length) {
  return length < kNearAntenna ? Real{} : Math::with_sign_of(root_gain * Math::root(Math::magnitude(cosine)) / length, cosine);
}

// The same for legs to a specular point, from which it is `to_first` (m) to the first diffuse hit.
template <class Real>
ECHOPATH_INLINE Real specular_leg(Real root_gain, Real length, Real to_first, Real root_cos_first) {
  return length < kNearAntenna ? Real{} : root_gain * root_cos_first / (length + to_first);
}

// One diffuse hit: its cosines must have one sign. Several: so must those of the first and those of the last hit.
template <class Math, class Real>
ECHOPATH_INLINE Real diffuse_product(Real start, Real end) {
  return Math::larger(Real{}, start * end);
}
template <class Math, class Real>
ECHOPATH_INLINE Real diffuse_product(Real start, Real end, Real first_sign, Real last_sign) {
  return Math::larger(Real{}, start * first_sign) * Math::larger(Real{}, end * last_sign);
}

}  // namespace echopath
