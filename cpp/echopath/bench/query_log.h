#pragma once
// Holds the queries of a trace as Embree got them, to be asked again without the tracer around them (bare_queries.h).
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
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
  // Says where a block of launch rays begins.
  struct Mark {
    size_t call = 0, ray = 0;
  };
  std::vector<Call> calls;
  std::vector<Ray> rays;  // of each call in turn
  std::vector<Mark> marks;

  // Adds the rays of a call; they stay together. Thread-safe.
  void add(Kind kind, std::span<const Ray> of_call) {
    const std::lock_guard lock(mutex_);
    calls.push_back({kind, static_cast<uint8_t>(of_call.size())});
    rays.insert(rays.end(), of_call.begin(), of_call.end());
  }
  void mark() { marks.push_back({calls.size(), rays.size()}); }

 private:
  std::mutex mutex_;
};

}  // namespace echopath
