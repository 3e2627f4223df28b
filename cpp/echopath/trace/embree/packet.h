#pragma once
// Holds rays side by side, quantity by quantity, so that compilers make vectors of loops over their lanes.
#include <array>

#include "echopath/base/packed.h"

namespace echopath {

inline constexpr int kPacketSize = 16;  // rays that Embree follows at a time

struct LaneRange {
  int begin, end;
};

// The values are not set at first.
template <class Value>
struct alignas(64) LanesOf {
  Value lanes[kPacketSize];

  ECHOPATH_INLINE Value& operator[](int lane) { return lanes[lane]; }
  ECHOPATH_INLINE Value operator[](int lane) const { return lanes[lane]; }
};
using LaneValues = LanesOf<double>;
using LaneFlags = std::array<bool, kPacketSize>;

struct LaneVectors {
  LaneValues x, y, z;

  ECHOPATH_INLINE VectorOf<double> at(int lane) const { return {x[lane], y[lane], z[lane]}; }
  ECHOPATH_INLINE void set(int lane, const VectorOf<double>& value) {
    x[lane] = value.x;
    y[lane] = value.y;
    z[lane] = value.z;
  }
  Vec3 operator[](int lane) const { return {x[lane], y[lane], z[lane]}; }
};

}  // namespace echopath
