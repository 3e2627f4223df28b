#pragma once
// Limits how far from the origin things may be, and how late: the same limits hold in all modules.
#include <cmath>
#include <string>
#include <string_view>

#include "echopath/base/errors.h"
#include "echopath/base/geometry.h"

namespace echopath {

// Everything lies within this distance of the origin that its coordinates count from. Embree multiplies three coordinates
// in single precision, which overflows beyond 2.4e12 m, and double precision resolves a thirtieth of a wave at 77 GHz up
// to here.
inline constexpr double kFarthest = 1e12;  // m
// Double precision tells apart times of 2e-6 s up to here; times since 1970 are below 2e9 s.
inline constexpr double kLatest = 1e10;  // s

inline bool is_in_range(const Vec3& position) { return (position.array().abs() <= kFarthest).all(); }  // NaN is not

// Raises invalid_argument naming `argument` and `what` unless the position is in range.
inline void require_in_range(const Vec3& position, std::string_view argument, std::string_view what) {
  if (is_in_range(position)) return;
  require(false, argument, std::string(what).append(" must lie within 1e12 m"), position.transpose());
}

// Raises invalid_argument naming `argument` unless `time` (s) is within kLatest; NaN is not.
inline void require_time(double time, std::string_view argument) {
  require(std::abs(time) <= kLatest, argument, "must lie in [-1e10, 1e10] s", time);
}

}  // namespace echopath
