// Holds vectors of ECHOPATH_LANES doubles, for kernels_body.h alone (no include guard: once per instruction set).
#include <cstdint>
#if defined(__FMA__)
#include <immintrin.h>
#endif

#include "echopath/base/simd.h"

namespace echopath::ECHOPATH_KERNELS {

constexpr int kLanes = ECHOPATH_LANES;
typedef double Vec __attribute__((vector_size(8 * kLanes)));
typedef double UnalignedVec __attribute__((vector_size(8 * kLanes), aligned(8), may_alias));
typedef int64_t Mask __attribute__((vector_size(8 * kLanes)));
typedef int32_t Cells __attribute__((vector_size(4 * kLanes)));
typedef int32_t UnalignedCells __attribute__((vector_size(4 * kLanes), aligned(4), may_alias));

ECHOPATH_INLINE Vec load(const double* from) { return *reinterpret_cast<const UnalignedVec*>(from); }
ECHOPATH_INLINE void store(double* to, Vec x) { *reinterpret_cast<UnalignedVec*>(to) = x; }
ECHOPATH_INLINE Vec all(double x) { return x - Vec{}; }
ECHOPATH_INLINE Mask bits(Vec x) { return reinterpret_cast<Mask>(x); }
ECHOPATH_INLINE Vec from_bits(Mask x) { return reinterpret_cast<Vec>(x); }

// Returns bits of which bit i tells that a[i] != b[i], for i in [0, 64).
ECHOPATH_INLINE uint64_t differences(const int32_t* a, const int32_t* b) {
  uint64_t bits = 0;
#if ECHOPATH_LANES == 8
  for (int i = 0; i < 4; ++i) {
    const uint64_t some = _mm512_cmpneq_epi32_mask(_mm512_loadu_si512(a + 16 * i), _mm512_loadu_si512(b + 16 * i));
    bits |= some << 16 * i;
  }
#elif ECHOPATH_LANES == 4
  for (int i = 0; i < 8; ++i) {
    const auto at = [i](const int32_t* from) { return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from + 8 * i)); };
    const int equal = _mm256_movemask_ps(_mm256_castsi256_ps(_mm256_cmpeq_epi32(at(a), at(b))));
    bits |= static_cast<uint64_t>(equal ^ 0xff) << 8 * i;
  }
#else
  for (int i = 0; i < 64; ++i) bits |= static_cast<uint64_t>(a[i] != b[i]) << i;
#endif
  return bits;
}

// Returns a * b + c; the compiler chooses how it is rounded.
ECHOPATH_INLINE Vec multiply_add(Vec a, Vec b, Vec c) { return a * b + c; }

// Returns a * b + c where c is nearly -a * b: the product is not rounded before c is added.
ECHOPATH_INLINE Vec exact_multiply_add(Vec a, Vec b, Vec c) {
#if ECHOPATH_LANES == 8
  return _mm512_fmadd_pd(a, b, c);
#elif ECHOPATH_LANES == 4
  return _mm256_fmadd_pd(a, b, c);
#else
  // Without a fused operation the product's own error follows from halves of 26 bits (Dekker 1971).
  constexpr double kSplit = 134217729.0;  // 2^27 + 1
  const Vec big_a = a * kSplit, big_b = b * kSplit;
  const Vec ah = big_a - (big_a - a), bh = big_b - (big_b - b);
  const Vec al = a - ah, bl = b - bh;
  const Vec product = a * b;
  const Vec error = ((ah * bh - product) + ah * bl + al * bh) + al * bl;
  return (product + c) + error;
#endif
}

// Holds vectors that take each step together: one vector alone would wait for its last result.
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

// Lane i of the result is the sum of all lanes of x[i].
ECHOPATH_INLINE Vec sums(const Vec* x) {
#if ECHOPATH_LANES == 8
  Vec pair[4], four[2];
  for (int i = 0; i < 4; ++i) {
    pair[i] = __builtin_shuffle(x[2 * i], x[2 * i + 1], Mask{0, 8, 2, 10, 4, 12, 6, 14}) +
              __builtin_shuffle(x[2 * i], x[2 * i + 1], Mask{1, 9, 3, 11, 5, 13, 7, 15});
  }
  for (int i = 0; i < 2; ++i) {
    four[i] = __builtin_shuffle(pair[2 * i], pair[2 * i + 1], Mask{0, 1, 8, 9, 4, 5, 12, 13}) +
              __builtin_shuffle(pair[2 * i], pair[2 * i + 1], Mask{2, 3, 10, 11, 6, 7, 14, 15});
  }
  return __builtin_shuffle(four[0], four[1], Mask{0, 1, 2, 3, 8, 9, 10, 11}) +
         __builtin_shuffle(four[0], four[1], Mask{4, 5, 6, 7, 12, 13, 14, 15});
#elif ECHOPATH_LANES == 4
  Vec pair[2];
  for (int i = 0; i < 2; ++i) {
    pair[i] = __builtin_shuffle(x[2 * i], x[2 * i + 1], Mask{0, 4, 2, 6}) +
              __builtin_shuffle(x[2 * i], x[2 * i + 1], Mask{1, 5, 3, 7});
  }
  return __builtin_shuffle(pair[0], pair[1], Mask{0, 1, 4, 5}) + __builtin_shuffle(pair[0], pair[1], Mask{2, 3, 6, 7});
#else
  return Vec{x[0][0], x[1][0]} + Vec{x[0][1], x[1][1]};
#endif
}

// The first lanes of the result are the sums of all lanes of a and of b.
ECHOPATH_INLINE Vec sums_of_two(Vec a, Vec b) {
#if ECHOPATH_LANES == 8
  Vec pair = __builtin_shuffle(a, b, Mask{0, 8, 2, 10, 4, 12, 6, 14}) + __builtin_shuffle(a, b, Mask{1, 9, 3, 11, 5, 13, 7, 15});
  pair = pair + __builtin_shuffle(pair, Mask{4, 5, 6, 7, 0, 1, 2, 3});
  return pair + __builtin_shuffle(pair, Mask{2, 3, 0, 1, 6, 7, 4, 5});
#elif ECHOPATH_LANES == 4
  const Vec pair = __builtin_shuffle(a, b, Mask{0, 4, 2, 6}) + __builtin_shuffle(a, b, Mask{1, 5, 3, 7});
  return pair + __builtin_shuffle(pair, Mask{2, 3, 0, 1});
#else
  return Vec{a[0], b[0]} + Vec{a[1], b[1]};
#endif
}

}  // namespace echopath::ECHOPATH_KERNELS
