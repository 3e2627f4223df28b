#pragma once
// Defines vectors of doubles as wide as the registers of one instruction set, and the functions that need its intrinsics.
// Only files that are compiled once for each instruction set include this header: echopath_kernels in CMake sets
// ECHOPATH_LANES, the number of doubles in a vector. Code compiled for one instruction set must not be linked into that of
// another, so all names stand in a namespace of the instruction set, ECHOPATH_KERNELS.
#include <cstddef>
#include <cstdint>
#include <numbers>
#if defined(__FMA__)
#include <immintrin.h>
#endif

#include "echopath/base/lanes/lanes.h"
#include "echopath/base/lanes/phasor.h"

#if ECHOPATH_LANES == 8
#define ECHOPATH_KERNELS kernels_avx512
#elif ECHOPATH_LANES == 4
#define ECHOPATH_KERNELS kernels_avx2
#else
#define ECHOPATH_KERNELS kernels_baseline
#endif

namespace echopath::ECHOPATH_KERNELS {

constexpr int kLanes = ECHOPATH_LANES;
constexpr InstructionSet kInstructionSet = kLanes == 8   ? InstructionSet::kAvx512
                                           : kLanes == 4 ? InstructionSet::kAvx2
                                                         : InstructionSet::kBaseline;
using Vec = Lanes<double, kLanes>;
using Mask = Lanes<int64_t, kLanes>;

ECHOPATH_INLINE Vec load(const double* from) { return load_lanes<kLanes>(from); }
ECHOPATH_INLINE void store(double* to, Vec x) { store_lanes(to, x); }
ECHOPATH_INLINE Vec all(double x) { return x - Vec{}; }
ECHOPATH_INLINE Mask bits(Vec x) { return reinterpret_cast<Mask>(x); }
ECHOPATH_INLINE Vec from_bits(Mask x) { return reinterpret_cast<Vec>(x); }

// Bit i tells that a[i] != b[i], for i in [0, 64).
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

// Returns a * b + c; which roundings it has is the compiler's choice.
ECHOPATH_INLINE Vec multiply_add(Vec a, Vec b, Vec c) { return a * b + c; }

// Returns a * b + c where c is nearly -a * b: the product is not rounded before c is added.
ECHOPATH_INLINE Vec exact_multiply_add(Vec a, Vec b, Vec c) {
#if ECHOPATH_LANES == 8
  return _mm512_fmadd_pd(a, b, c);
#elif ECHOPATH_LANES == 4
  return _mm256_fmadd_pd(a, b, c);
#else
  // Without a fused operation, the product's own error is found from halves of 26 bits (Dekker 1971).
  constexpr double kSplit = 134217729.0;  // 2^27 + 1
  const Vec big_a = a * kSplit, big_b = b * kSplit;
  const Vec ah = big_a - (big_a - a), bh = big_b - (big_b - b);
  const Vec al = a - ah, bl = b - bh;
  const Vec product = a * b;
  const Vec error = ((ah * bh - product) + ah * bl + al * bh) + al * bl;
  return (product + c) + error;
#endif
}

// Returns every other number of a and b in a row, from the number kFirst (0 or 1) on.
template <int kFirst>
ECHOPATH_INLINE Vec every_other(Vec a, Vec b) {
  constexpr int k = kFirst;
#if ECHOPATH_LANES == 8
  return __builtin_shufflevector(a, b, k, k + 2, k + 4, k + 6, k + 8, k + 10, k + 12, k + 14);
#elif ECHOPATH_LANES == 4
  return __builtin_shufflevector(a, b, k, k + 2, k + 4, k + 6);
#else
  return __builtin_shufflevector(a, b, k, k + 2);
#endif
}

// Returns a[0], b[0], a[1], b[1] and so on: the half kHalf (0 or 1) of them that fits a vector.
template <int kHalf>
ECHOPATH_INLINE Vec interleaved(Vec a, Vec b) {
  constexpr int k = kHalf * kLanes / 2, l = k + kLanes;
#if ECHOPATH_LANES == 8
  return __builtin_shufflevector(a, b, k, l, k + 1, l + 1, k + 2, l + 2, k + 3, l + 3);
#elif ECHOPATH_LANES == 4
  return __builtin_shufflevector(a, b, k, l, k + 1, l + 1);
#else
  return __builtin_shufflevector(a, b, k, l);
#endif
}

// Returns the lanes of a but the first, then the first of b.
ECHOPATH_INLINE Vec without_first(Vec a, Vec b) {
#if ECHOPATH_LANES == 8
  return __builtin_shufflevector(a, b, 1, 2, 3, 4, 5, 6, 7, 8);
#elif ECHOPATH_LANES == 4
  return __builtin_shufflevector(a, b, 1, 2, 3, 4);
#else
  return __builtin_shufflevector(a, b, 1, 2);
#endif
}

// Lane i of the result is the sum of all lanes of x[i].
ECHOPATH_INLINE Vec sums(const Vec* x) {
#if ECHOPATH_LANES == 8
  Vec pair[4], four[2];
  for (int i = 0; i < 4; ++i) {
    pair[i] = __builtin_shufflevector(x[2 * i], x[2 * i + 1], 0, 8, 2, 10, 4, 12, 6, 14) +
              __builtin_shufflevector(x[2 * i], x[2 * i + 1], 1, 9, 3, 11, 5, 13, 7, 15);
  }
  for (int i = 0; i < 2; ++i) {
    four[i] = __builtin_shufflevector(pair[2 * i], pair[2 * i + 1], 0, 1, 8, 9, 4, 5, 12, 13) +
              __builtin_shufflevector(pair[2 * i], pair[2 * i + 1], 2, 3, 10, 11, 6, 7, 14, 15);
  }
  return __builtin_shufflevector(four[0], four[1], 0, 1, 2, 3, 8, 9, 10, 11) +
         __builtin_shufflevector(four[0], four[1], 4, 5, 6, 7, 12, 13, 14, 15);
#elif ECHOPATH_LANES == 4
  Vec pair[2];
  for (int i = 0; i < 2; ++i) {
    pair[i] = __builtin_shufflevector(x[2 * i], x[2 * i + 1], 0, 4, 2, 6) +
              __builtin_shufflevector(x[2 * i], x[2 * i + 1], 1, 5, 3, 7);
  }
  return __builtin_shufflevector(pair[0], pair[1], 0, 1, 4, 5) + __builtin_shufflevector(pair[0], pair[1], 2, 3, 6, 7);
#else
  return Vec{x[0][0], x[1][0]} + Vec{x[0][1], x[1][1]};
#endif
}

// Its first lanes are the sums of all lanes of a and of b.
ECHOPATH_INLINE Vec sums_of_two(Vec a, Vec b) {
#if ECHOPATH_LANES == 8
  Vec pair =
      __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14) + __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
  pair = pair + __builtin_shufflevector(pair, pair, 4, 5, 6, 7, 0, 1, 2, 3);
  return pair + __builtin_shufflevector(pair, pair, 2, 3, 0, 1, 6, 7, 4, 5);
#elif ECHOPATH_LANES == 4
  const Vec pair = __builtin_shufflevector(a, b, 0, 4, 2, 6) + __builtin_shufflevector(a, b, 1, 5, 3, 7);
  return pair + __builtin_shufflevector(pair, pair, 2, 3, 0, 1);
#else
  return Vec{a[0], b[0]} + Vec{a[1], b[1]};
#endif
}

constexpr double kMaxNegativeExponent = -708.0;  // e^x below is taken as 0

// Gives the functions of ScalarMath for vectors.
struct LaneMath {
  using Real = Vec;
  static constexpr size_t kCount = kLanes;
  static ECHOPATH_INLINE Vec load(const double* from) { return ECHOPATH_KERNELS::load(from); }
  static ECHOPATH_INLINE void store(double* to, Vec x) { ECHOPATH_KERNELS::store(to, x); }

  static ECHOPATH_INLINE Vec root(Vec x) {
#if ECHOPATH_LANES == 8
    return _mm512_maskz_sqrt_pd(0xFF, x);  // the plain one warns of its own undefined lanes
#elif ECHOPATH_LANES == 4
    return _mm256_sqrt_pd(x);
#else
    return Vec{__builtin_sqrt(x[0]), __builtin_sqrt(x[1])};
#endif
  }
  static constexpr int64_t kSignBit = ~int64_t{0x7FFFFFFFFFFFFFFF};
  static ECHOPATH_INLINE Vec magnitude(Vec x) { return from_bits(bits(x) & ~kSignBit); }
  static ECHOPATH_INLINE Vec with_sign_of(Vec x, Vec sign) {
    return from_bits((bits(x) & ~kSignBit) | (bits(sign) & kSignBit));
  }
  static ECHOPATH_INLINE Vec larger(Vec x, Vec y) { return x > y ? x : y; }
  static ECHOPATH_INLINE Vec smaller(Vec x, Vec y) { return x < y ? x : y; }
  static ECHOPATH_INLINE bool any(Mask x) {
#if ECHOPATH_LANES == 8
    return _mm512_movepi64_mask(reinterpret_cast<__m512i>(x)) != 0;
#elif ECHOPATH_LANES == 4
    return _mm256_movemask_pd(reinterpret_cast<__m256d>(x)) != 0;
#endif
    int64_t found = 0;
    for (int lane = 0; lane < kLanes; ++lane) found |= x[lane];
    return found != 0;
  }

  // Returns e^x for x <= 700 with a relative error of 4e-16: 2^k times the series of the rest, |rest| <= ln(2)/2.
  static ECHOPATH_INLINE Vec exp(Vec x) {
    constexpr double kLog2E = 1.4426950408889634, kLn2High = 0.6931471803691238, kLn2Low = 1.9082149292705877e-10;
    const Vec shifted = larger(x, all(kMaxNegativeExponent)) * kLog2E + kRoundingShift, k = shifted - kRoundingShift;
    const Vec rest = (larger(x, all(kMaxNegativeExponent)) - k * kLn2High) - k * kLn2Low;
    // 1/n! for n to 13, in pairs, so that most terms do not wait for others; what is large comes last.
    const Vec square = rest * rest, fourth = square * square;
    const Vec high = (rest * (1.0 / 6227020800.0) + 1.0 / 479001600.0) * fourth +
                     ((rest * (1.0 / 39916800.0) + 1.0 / 3628800.0) * square + (rest * (1.0 / 362880.0) + 1.0 / 40320.0));
    const Vec middle = (rest * (1.0 / 5040.0) + 1.0 / 720.0) * square + (rest * (1.0 / 120.0) + 1.0 / 24.0);
    const Vec tail = (high * fourth + middle) * square + (rest * (1.0 / 6.0) + 0.5);
    const Vec sum = (tail * square + rest) + 1.0;
    const Vec power = from_bits(bits(sum) + (bits(shifted) << 52));
    return x < kMaxNegativeExponent ? Vec{} : power;
  }

  static ECHOPATH_INLINE ComplexOf<Vec> cis(Vec x) {
    constexpr double kPerPi = std::numbers::inv_pi, kPiHigh = 3.141592653589793, kPiLow = 1.2246467991473532e-16;
    const Vec shifted = x * kPerPi + kRoundingShift, half_turns = shifted - kRoundingShift;
    const Vec rest = exact_multiply_add(half_turns, all(-kPiHigh), x) - half_turns * kPiLow;
    const ComplexOf<Vec> phasor = phasor_of_half_turns(rest * kPerPi);
    const Mask sign = bits(shifted) << 63;
    return {from_bits(bits(phasor.re) ^ sign), from_bits(bits(phasor.im) ^ sign)};
  }
};

// Holds the square roots of values that are not negative, and their inverses, to an error in the last digits. Values below
// kMinSquare count as kMinSquare. Square roots and divisions of eight lanes take as long as twenty multiplications.
struct Roots {
  Vec root, inverse;
};
constexpr double kMinSquare = 1e-60;
ECHOPATH_INLINE Roots roots_of(Vec square) {
  const Vec x = LaneMath::larger(square, all(kMinSquare));
#if ECHOPATH_LANES == 8
  Vec y = _mm512_maskz_rsqrt14_pd(0xFF, x);
  for (int step = 0; step < 2; ++step) y = y + 0.5 * y * exact_multiply_add(-x * y, y, all(1.0));
  const Vec root = x * y;
  return {root + 0.5 * y * exact_multiply_add(-root, root, x), y};
#else
  const Vec root = LaneMath::root(x);
  return {root, 1.0 / root};
#endif
}

}  // namespace echopath::ECHOPATH_KERNELS
