#pragma once
// What stands in the way of legs, found once for all paths that share them: one ray makes a path over each pair of the mirror
// chains to its hits, so most legs are those of other paths, too.
#include <vector>

#include "echopath/replay/evaluate/segment_ids.h"
#include "echopath/validity/leg_shadows.h"

namespace echopath {

// Of one instant; for one thread at a time.
class LegMemo {
 public:
  // What `find` returned for the same `count` hits under the same `kind`, or returns now. The hits must stay where they are.
  template <class Find>
  LegShadows operator()(const Hit* hits, int count, uint64_t kind, Find find) {
    uint32_t& id = ids_(hits, count, kind);
    if (id == SegmentIds::kNone) {
      id = static_cast<uint32_t>(known_.size());
      known_.push_back(find());
    }
    return known_[id];
  }

 private:
  SegmentIds ids_;
  std::vector<LegShadows> known_;
};

}  // namespace echopath
