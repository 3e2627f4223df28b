#pragma once
// Puts real and imaginary parts side by side, as std::complex has them.
#include <cstdint>

#include "echopath/base/lanes/simd.h"

namespace echopath {

// Writes the pairs of re and im [count] to out [count, 2]. It is inlined into what run_simd compiles for each instruction
// set.
ECHOPATH_INLINE void interleave(const double* re, const double* im, int64_t count, double* __restrict out) {
  for (int64_t i = 0; i < count; ++i) {
    out[2 * i] = re[i];
    out[2 * i + 1] = im[i];
  }
}

}  // namespace echopath
