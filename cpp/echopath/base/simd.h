#pragma once
// Hot loops are compiled once per instruction set, and the best that the machine has is picked at run time: one binary for
// all machines. Bits differ between instruction sets (fused multiply-add, order of lanes), never between thread counts.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__)
#define ECHOPATH_X86_KERNELS 1
#endif
// Helpers of such loops must be inlined to be compiled for the same instruction set.
#define ECHOPATH_INLINE inline __attribute__((always_inline))

// Before a loop: do not unroll it; its rounds may run side by side, whatever its pointers suggest.
#if defined(__clang__)
#define ECHOPATH_NO_UNROLL _Pragma("clang loop unroll(disable)")
#define ECHOPATH_SIDE_BY_SIDE _Pragma("clang loop vectorize(assume_safety)")
#else
#define ECHOPATH_NO_UNROLL _Pragma("GCC unroll 1")
#define ECHOPATH_SIDE_BY_SIDE _Pragma("GCC ivdep")
#endif

namespace echopath {

enum class InstructionSet { kBaseline, kAvx2, kAvx512 };

// The best that machine and compiler have, or what the environment variable ECHOPATH_INSTRUCTION_SET names: baseline, avx2 or
// avx512. Fixed at the first call. Raises invalid_argument where the variable names another, or one that the machine lacks.
InstructionSet instruction_set();
const char* name_of(InstructionSet set);

#ifdef ECHOPATH_X86_KERNELS
template <auto kLoop, class... Args>
__attribute__((target("arch=x86-64-v4,prefer-vector-width=512"))) void run_for_avx512(Args... args) {
  kLoop(args...);
}
template <auto kLoop, class... Args>
__attribute__((target("arch=x86-64-v3"))) void run_for_avx2(Args... args) {
  kLoop(args...);
}
#endif

// Runs a plain loop, an ECHOPATH_INLINE function that takes numbers and pointers, compiled for the instruction set picked.
template <auto kLoop, class... Args>
void run_simd(Args... args) {
#ifdef ECHOPATH_X86_KERNELS
  if (instruction_set() == InstructionSet::kAvx512) return run_for_avx512<kLoop>(args...);
  if (instruction_set() == InstructionSet::kAvx2) return run_for_avx2<kLoop>(args...);
#endif
  kLoop(args...);
}

}  // namespace echopath
