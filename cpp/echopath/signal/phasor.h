#pragma once
// e^{j 2 pi x} from a phase in cycles, written so that compilers vectorise the loops that call it.
#include "echopath/base/simd.h"

namespace echopath {

// Nearest integer for |x| < 2^51, without a library call: adding 1.5 * 2^52 leaves no bits for the fraction.
ECHOPATH_INLINE double round_to_integer(double x) {
  constexpr double kShift = 6755399441055744.0;
  return (x + kShift) - kShift;
}

struct Phasor {
  double re, im;
};

// Absolute error below 5e-16 for |x| <= 1/2: Taylor series on [-pi/2, pi/2] after removal of half turns.
ECHOPATH_INLINE Phasor phasor_of_reduced_cycles(double x) {
  const double half_turns = round_to_integer(2.0 * x);  // -1, 0 or 1
  const double sign = 1.0 - 2.0 * half_turns * half_turns;
  const double t = 6.283185307179586 * (x - 0.5 * half_turns);
  const double y = t * t;
  double c = -8.896791392450574e-22;  // -1/22!
  c = c * y + 4.110317623312165e-19;
  c = c * y - 1.5619206968586225e-16;
  c = c * y + 4.779477332387385e-14;
  c = c * y - 1.1470745597729725e-11;
  c = c * y + 2.08767569878681e-09;
  c = c * y - 2.755731922398589e-07;
  c = c * y + 2.48015873015873e-05;
  c = c * y - 0.001388888888888889;
  c = c * y + 0.041666666666666664;
  c = c * y - 0.5;
  c = c * y + 1.0;
  double s = 1.9572941063391263e-20;  // 1/21!
  s = s * y - 8.22063524662433e-18;
  s = s * y + 2.8114572543455206e-15;
  s = s * y - 7.647163731819816e-13;
  s = s * y + 1.6059043836821613e-10;
  s = s * y - 2.505210838544172e-08;
  s = s * y + 2.7557319223985893e-06;
  s = s * y - 0.0001984126984126984;
  s = s * y + 0.008333333333333333;
  s = s * y - 0.16666666666666666;
  s = s * y + 1.0;
  return {sign * c, sign * (s * t)};
}

ECHOPATH_INLINE Phasor phasor_of_cycles(double x) { return phasor_of_reduced_cycles(x - round_to_integer(x)); }

}  // namespace echopath
