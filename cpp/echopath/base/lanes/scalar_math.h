#pragma once
// Functions of doubles under the names by which formulas ask for them that are written for vectors of doubles too: such a
// formula takes a class like this one, which has no code of its own: what is compiled for one instruction set must not be
// linked into another's.
#include "echopath/base/lanes/simd.h"

namespace echopath {

// A complex number, or a vector of them: Real is a number or a vector of numbers.
template <class Real>
struct ComplexOf {
  Real re, im;
};

struct ScalarMath {
  using Real = double;
  static ECHOPATH_INLINE double root(double x) { return __builtin_sqrt(x); }
  static ECHOPATH_INLINE double magnitude(double x) { return __builtin_fabs(x); }
  static ECHOPATH_INLINE double with_sign_of(double x, double sign) { return __builtin_copysign(x, sign); }
  static ECHOPATH_INLINE double larger(double x, double y) { return x > y ? x : y; }
  static ECHOPATH_INLINE double smaller(double x, double y) { return x < y ? x : y; }
  static ECHOPATH_INLINE double exp(double x) { return __builtin_exp(x); }
  // Returns e^{jx}, x in rad.
  static ECHOPATH_INLINE ComplexOf<double> cis(double x) { return {__builtin_cos(x), __builtin_sin(x)}; }
  static ECHOPATH_INLINE bool any(bool x) { return x; }
};

}  // namespace echopath
