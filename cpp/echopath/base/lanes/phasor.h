#pragma once
// Computes e^{j pi x} and e^{j 2 pi x}, written for doubles in loops that compilers vectorise and for vectors of doubles
// alike.
#include <cmath>

#include "echopath/base/lanes/scalar_math.h"
#include "echopath/base/lanes/simd.h"

namespace echopath {

// Adding this to |x| < 2^51 leaves no bits for the fraction, and the lowest bit tells odd from even.
inline constexpr double kRoundingShift = 6755399441055744.0;  // 1.5 * 2^52

// Returns the nearest integer, without a library call.
template <class Real>
ECHOPATH_INLINE Real round_to_integer(Real x) {
  return (x + kRoundingShift) - kRoundingShift;
}

using Phasor = ComplexOf<double>;

// Says how far e^{j pi x} for |x| <= 1/2 may be off, absolutely.
enum class PhasorError { kRounding, k1em12, k7em6 };

// Returns e^{j pi x} for |x| <= 1/2 by polynomials in x^2 through Chebyshev nodes of [0, 1/4] (Trefethen 2013, chapter 8).
// At kRounding they are off by 4e-18 (cosine) and 2e-16 (sine) before rounding, by 5e-16 in all.
template <PhasorError kError = PhasorError::kRounding, class Real>
ECHOPATH_INLINE ComplexOf<Real> phasor_of_half_turns(Real x) {
  const Real y = x * x;
  Real c, s;
  if constexpr (kError == PhasorError::kRounding) {
    c = y * 4.149564353942586e-06 - 0.00010456655338748738;
    c = c * y + 0.0019295562724817132;
    c = c * y - 0.025806888737002202;
    c = c * y + 0.23533063012953284;
    c = c * y - 1.335262768843447;
    c = c * y + 4.058712126416497;
    c = c * y - 4.934802200544676;
    c = c * y + 1.0;
    s = y * -2.113362735205297e-05 + 0.0004659870158043378;
    s = s * y - 0.0073703643265304155;
    s = s * y + 0.08214587881631043;
    s = s * y - 0.599264528825224;
    s = s * y + 2.5501640398618677;
    s = s * y - 5.1677127800497855;
    s = s * y + 3.1415926535897927;
  } else if constexpr (kError == PhasorError::k1em12) {
    c = y * 0.001839989437269404 - 0.02577631642731586;
    c = c * y + 0.2353254365877112;
    c = c * y - 1.33526231526157;
    c = c * y + 4.0587121075374375;
    c = c * y - 4.93480220024985;
    c = c * y + 0.9999999999992479;
    s = y * 0.0004474920849077101 - 0.007364005472115722;
    s = s * y + 0.08214479467064854;
    s = s * y - 0.5992644339357286;
    s = s * y + 2.550164035906745;
    s = s * y - 5.167712779987959;
    s = s * y + 3.141592653589635;
  } else {
    c = y * -1.22193646439004 + 4.041212337116102;
    c = c * y - 4.933931310725943;
    c = c * y + 0.9999932021003466;
    s = y * -0.5594350008334862 + 2.5440002161871855;
    s = s * y - 5.167405766362026;
    s = s * y + 3.1415902567479046;
  }
  return {c, s * x};
}

// Returns e^{j 2 pi x}.
template <class Real>
ECHOPATH_INLINE ComplexOf<Real> phasor_of_cycles(Real x) {
  const Real reduced = 2.0 * (x - round_to_integer(x));  // half turns in [-1, 1]
  const Real half_turns = round_to_integer(reduced);     // -1, 0 or 1
  const Real sign = 1.0 - 2.0 * half_turns * half_turns;
  const ComplexOf<Real> phasor = phasor_of_half_turns(reduced - half_turns);
  return {sign * phasor.re, sign * phasor.im};
}

// Returns e^{j 2 pi a b} of the two doubles, off by 5e-15 for up to 2^40 turns: what rounding takes off the product is
// added again.
ECHOPATH_INLINE Phasor phasor_of_product(double a, double b) {
  const double turns = a * b, rest = std::fma(a, b, -turns);
  return phasor_of_cycles((turns - round_to_integer(turns)) + rest);
}

}  // namespace echopath
