#pragma once
// Gives formulas their mathematical functions. A formula that serves single numbers and vectors of numbers takes them from a
// class `Math`: ScalarMath for numbers, LaneMath for vectors (lane_math.h). All functions of ScalarMath are inlined, so that
// no code compiled for one instruction set is linked into that of another.
#include "echopath/base/lanes/simd.h"

namespace echopath {

// Holds a complex number where Real is a number, and a vector of complex numbers where Real is a vector of numbers.
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
