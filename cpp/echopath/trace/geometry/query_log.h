#pragma once
// The queries of a trace as Embree got them, to be asked again without the tracer around them (bare_queries.h).
#include <cstddef>
#include <cstdint>
#include <vector>

#include "echopath/base/vector_of.h"

namespace echopath {

struct QueryLog {
  enum class Kind : uint8_t { kClosest, kClosestPacket, kShadow, kShadowPacket };
  struct Call {
    Kind kind;
    uint8_t num_rays;
  };
  struct Ray {
    VectorOf<float> from, direction;
    float far;  // m; negative: a lane that is not in use
  };
  // Where a block of launch rays begins.
  struct Mark {
    size_t call = 0, ray = 0;
  };
  std::vector<Call> calls;
  std::vector<Ray> rays;  // of each call in turn
  std::vector<Mark> marks;

  void add(const VectorOf<double>& from, const VectorOf<double>& direction, double far) {
    const auto rounded = [](const VectorOf<double>& v) {
      return VectorOf<float>{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
    };
    rays.push_back({rounded(from), rounded(direction), static_cast<float>(far)});
  }
  void mark() { marks.push_back({calls.size(), rays.size()}); }
};

}  // namespace echopath
