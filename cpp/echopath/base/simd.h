#pragma once
// Hot loops are plain loops; GCC compiles the functions marked here once per instruction set and picks
// at load time. Bits differ between instruction sets (fused multiply-add), never between thread counts.
// Sanitizers run before the picking is possible, and clang 14 does not know these names: one baseline version there.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define ECHOPATH_SIMD __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define ECHOPATH_SIMD
#endif
// Helpers of such functions must be inlined to be compiled for the same instruction set.
#define ECHOPATH_INLINE inline __attribute__((always_inline))

#if defined(__clang__)
#define ECHOPATH_NO_UNROLL _Pragma("clang loop unroll(disable)")
#else
#define ECHOPATH_NO_UNROLL _Pragma("GCC unroll 1")
#endif
