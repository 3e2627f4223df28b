#pragma once
// The queries of a trace as Embree got them, to be asked again without the tracer around them (bare_queries.h).
#include <cstdint>
#include <vector>

#include "echopath/base/geometry.h"

namespace echopath {

struct QueryLog {
  enum class Kind : uint8_t { kClosest, kClosestPacket, kShadow, kShadowPacket };
  struct Call {
    Kind kind;
    uint8_t num_rays;
  };
  struct Ray {
    Eigen::Vector3f from, direction;
    float far;  // m; 0: a lane that is not in use
  };
  // Where a block of launch rays begins.
  struct Mark {
    size_t call = 0, ray = 0;
  };
  std::vector<Call> calls;
  std::vector<Ray> rays;  // of each call in turn
  std::vector<Mark> marks;

  void add(const Vec3& from, const Vec3& direction, float far) {
    rays.push_back({from.cast<float>(), direction.cast<float>(), far});
  }
  void mark() { marks.push_back({calls.size(), rays.size()}); }
};

}  // namespace echopath
