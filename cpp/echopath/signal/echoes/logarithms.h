#pragma once
// Converts amplitudes of echoes to logarithms and back (TimeSampling::Rows::kLogarithms), one by one or in vectors.
#include "echopath/base/lanes/scalar_math.h"

namespace echopath {

// Returns the amplitude of which the logarithm of the size and the phase (rad) are given. Math is as in scalar_math.h.
template <class Math, class Real = typename Math::Real>
ECHOPATH_INLINE ComplexOf<Real> without_logarithm(Real log_size, Real phase) {
  const Real size = Math::exp(log_size);
  const ComplexOf<Real> phasor = Math::cis(phase);
  return {size * phasor.re, size * phasor.im};
}

}  // namespace echopath
