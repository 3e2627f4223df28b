#pragma once
// Defines the vector type of all hot loops: numbers side by side in a register, which operators take lane by lane
// (`mask ? a : b` chooses). Formulas take it by value: references to it cost 15 to 28 % of replay.
//
// Loops that compilers vectorise by themselves need none, and keep lanes in arrays (the rays of a packet, for example):
// GCC 12 makes poor code of vectors that are wider than a register.
#include "echopath/base/lanes/simd.h"

namespace echopath {

// `Aligned` is a vector in a register, `Anywhere` one in memory, at any place where a number may stand.
template <class Number, int kCount>
struct LanesType {
  typedef Number Aligned __attribute__((vector_size(kCount * sizeof(Number))));
  typedef Number Anywhere __attribute__((vector_size(kCount * sizeof(Number)), aligned(alignof(Number)), may_alias));
};
template <class Number, int kCount>
using Lanes = typename LanesType<Number, kCount>::Aligned;

// Loading and storing need no more than the alignment of the numbers.
template <int kCount, class Number>
ECHOPATH_INLINE Lanes<Number, kCount> load_lanes(const Number* from) {
  return *reinterpret_cast<const typename LanesType<Number, kCount>::Anywhere*>(from);
}
template <class Number, class Vector>
ECHOPATH_INLINE void store_lanes(Number* to, Vector x) {
  *reinterpret_cast<typename LanesType<Number, static_cast<int>(sizeof(Vector) / sizeof(Number))>::Anywhere*>(to) = x;
}

}  // namespace echopath
