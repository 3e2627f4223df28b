#pragma once
// Holds some vectors side by side, for files that are compiled once per instruction set (lane_math.h).
#include "echopath/base/lanes/lane_math.h"

namespace echopath::ECHOPATH_KERNELS {

// These vectors take each step together: the chain of one is short of work while it waits for its last result.
template <int kCount>
struct Vecs {
  Vec of[kCount];
};
template <int kCount, class Step>
ECHOPATH_INLINE Vecs<kCount> each(Step step) {
  Vecs<kCount> out;
#pragma GCC unroll 8
  for (int i = 0; i < kCount; ++i) out.of[i] = step(i);
  return out;
}
template <int kCount>
ECHOPATH_INLINE Vecs<kCount> operator*(const Vecs<kCount>& a, const Vecs<kCount>& b) {
  return each<kCount>([&](int i) __attribute__((always_inline)) { return a.of[i] * b.of[i]; });
}
template <int kCount>
ECHOPATH_INLINE Vecs<kCount> operator*(const Vecs<kCount>& a, double b) {
  return each<kCount>([&](int i) __attribute__((always_inline)) { return a.of[i] * b; });
}
template <int kCount>
ECHOPATH_INLINE Vecs<kCount> operator+(const Vecs<kCount>& a, const Vecs<kCount>& b) {
  return each<kCount>([&](int i) __attribute__((always_inline)) { return a.of[i] + b.of[i]; });
}
template <int kCount>
ECHOPATH_INLINE Vecs<kCount> operator+(const Vecs<kCount>& a, double b) {
  return each<kCount>([&](int i) __attribute__((always_inline)) { return a.of[i] + b; });
}
template <int kCount>
ECHOPATH_INLINE Vecs<kCount> operator-(const Vecs<kCount>& a, const Vecs<kCount>& b) {
  return each<kCount>([&](int i) __attribute__((always_inline)) { return a.of[i] - b.of[i]; });
}
template <int kCount>
ECHOPATH_INLINE Vecs<kCount> operator-(const Vecs<kCount>& a, double b) {
  return each<kCount>([&](int i) __attribute__((always_inline)) { return a.of[i] - b; });
}
template <int kCount>
ECHOPATH_INLINE Vecs<kCount> operator-(double a, const Vecs<kCount>& b) {
  return each<kCount>([&](int i) __attribute__((always_inline)) { return a - b.of[i]; });
}
template <int kCount>
ECHOPATH_INLINE Vecs<kCount> exact_multiply_add(const Vecs<kCount>& a, double b, const Vecs<kCount>& c) {
  return each<kCount>([&](int i) __attribute__((always_inline)) { return exact_multiply_add(a.of[i], all(b), c.of[i]); });
}

}  // namespace echopath::ECHOPATH_KERNELS
