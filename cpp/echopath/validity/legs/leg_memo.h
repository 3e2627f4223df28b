#pragma once
// Remembers what stands in the way of legs, so that it is found once for all paths that share them: one ray makes a path
// over each pair of the mirror chains to its hits, so most legs are those of other paths, too.
#include <vector>

#include "echopath/replay/evaluate/segment_ids.h"
#include "echopath/validity/legs/leg_shadows.h"

namespace echopath {

// Keeps the results of tests of legs at one time. It serves one thread at a time.
class LegMemo {
 public:
  // Returns what `find` returns for these `count` hits under this `kind`, and calls it once for the same ones. The hits must
  // stay where they are.
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
