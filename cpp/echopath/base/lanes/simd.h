#pragma once
// Hot loops are compiled once per instruction set, and the best that the machine has is picked at run time: one binary for
// all machines. Bits differ between instruction sets (fused multiply-add, order of lanes), never between thread counts.
//
// `with_instruction_set` is the one place that picks. It has two uses, since GCC has two ways to compile for an
// instruction set:
//  * run_simd: a loop is compiled by function target where it stands. All that it calls must be inlined, and be free of
//    intrinsics: GCC 12 rejects these in functions that are not marked for their set.
//  * kernels<Table>: a text with intrinsics and functions of its own is compiled as a file of its own for each set
//    (echopath_kernels in CMake). By function target, those functions would be compiled as baseline code, which takes
//    synthesis 2.4 times as long as AVX2.
#include <type_traits>

#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__)
#define ECHOPATH_X86_KERNELS 1
#endif
// Helpers of such loops must be inlined to be compiled for the same instruction set.
#define ECHOPATH_INLINE inline __attribute__((always_inline))

// These stand before a loop: the first keeps it from being unrolled, the second says that its rounds may run side by side,
// whatever its pointers suggest.
#if defined(__clang__)
#define ECHOPATH_NO_UNROLL _Pragma("clang loop unroll(disable)")
#define ECHOPATH_SIDE_BY_SIDE _Pragma("clang loop vectorize(assume_safety)")
#else
#define ECHOPATH_NO_UNROLL _Pragma("GCC unroll 1")
#define ECHOPATH_SIDE_BY_SIDE _Pragma("GCC ivdep")
#endif

namespace echopath {

enum class InstructionSet { kBaseline, kAvx2, kAvx512 };

// Returns the best that machine and compiler have, or what the environment variable ECHOPATH_INSTRUCTION_SET names:
// baseline, avx2 or avx512. It is fixed at the first call. Raises invalid_argument where the variable names another, or one
// that the machine lacks.
InstructionSet instruction_set();
// Tells whether the variable named it. Fixed and raised as that.
bool is_instruction_set_asked();
const char* name_of(InstructionSet set);

// Calls `call` with the instruction set picked, as a constant.
template <class Call>
ECHOPATH_INLINE decltype(auto) with_instruction_set(Call call) {
#ifdef ECHOPATH_X86_KERNELS
  [[maybe_unused]] const InstructionSet set = instruction_set();
#ifndef ECHOPATH_WITHOUT_AVX512
  if (set == InstructionSet::kAvx512) return call(std::integral_constant<InstructionSet, InstructionSet::kAvx512>{});
#endif
#ifndef ECHOPATH_WITHOUT_AVX2
  if (set == InstructionSet::kAvx2) return call(std::integral_constant<InstructionSet, InstructionSet::kAvx2>{});
#endif
#endif
  return call(std::integral_constant<InstructionSet, InstructionSet::kBaseline>{});
}

template <InstructionSet kSet>
struct FunctionTarget {
  template <auto kLoop, class... Args>
  static ECHOPATH_INLINE void run(Args... args) {
    kLoop(args...);
  }
};
#ifdef ECHOPATH_X86_KERNELS
template <>
struct FunctionTarget<InstructionSet::kAvx2> {
  template <auto kLoop, class... Args>
  __attribute__((target("arch=x86-64-v3"))) static void run(Args... args) {
    kLoop(args...);
  }
};
template <>
struct FunctionTarget<InstructionSet::kAvx512> {
  template <auto kLoop, class... Args>
  __attribute__((target("arch=x86-64-v4,prefer-vector-width=512"))) static void run(Args... args) {
    kLoop(args...);
  }
};
#endif

// Runs a plain loop, an ECHOPATH_INLINE function that takes numbers and pointers, compiled for the instruction set picked.
template <auto kLoop, class... Args>
void run_simd(Args... args) {
  with_instruction_set(
      [&](auto set) __attribute__((always_inline)) { FunctionTarget<decltype(set)::value>::template run<kLoop>(args...); });
}

// Returns how many doubles the loops that are written for several widths take at a time.
inline int num_simd_lanes() { return instruction_set() == InstructionSet::kAvx512 ? 8 : 4; }

// Runs the one of two such loops, for eight and for four lanes, that is written for num_simd_lanes().
template <auto kOfEight, auto kOfFour, class... Args>
void run_simd_lanes(Args... args) {
  if (num_simd_lanes() == 8) run_simd<kOfEight>(args...);
  else run_simd<kOfFour>(args...);
}

// Returns the table of functions compiled for one instruction set: each file that is compiled for it specialises this for
// its table.
template <class Table, InstructionSet kSet>
const Table& kernels_for();

// Returns that of the instruction set picked.
template <class Table>
const Table& kernels() {
  return with_instruction_set(
      [](auto set) __attribute__((always_inline)) -> const Table& { return kernels_for<Table, decltype(set)::value>(); });
}

}  // namespace echopath
