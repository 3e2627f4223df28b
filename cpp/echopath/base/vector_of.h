#pragma once
// Defines small vectors of numbers, or of vectors of numbers, for formulas that are compiled for single values and for lanes
// alike.
#include "echopath/base/lanes/simd.h"

namespace echopath {

template <class Real>
struct VectorOf {
  Real x, y, z;
};

template <class Real>
ECHOPATH_INLINE VectorOf<Real> operator+(const VectorOf<Real>& a, const VectorOf<Real>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class Real>
ECHOPATH_INLINE VectorOf<Real> operator-(const VectorOf<Real>& a, const VectorOf<Real>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class Real>
ECHOPATH_INLINE VectorOf<Real> operator*(Real factor, const VectorOf<Real>& a) {
  return {factor * a.x, factor * a.y, factor * a.z};
}
template <class Real>
ECHOPATH_INLINE Real dot(const VectorOf<Real>& a, const VectorOf<Real>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Real>
ECHOPATH_INLINE VectorOf<Real> cross(const VectorOf<Real>& a, const VectorOf<Real>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace echopath
