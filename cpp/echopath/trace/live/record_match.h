#pragma once
// Tells what two records of a scene before and after an edit have in common.
#include <vector>

#include "echopath/trace/live/live_record.h"
#include "echopath/trace/live/path_difference.h"

namespace echopath {

class RecordMatch {
 public:
  // `before` may be null; then nothing is the same.
  RecordMatch(const LiveRecord* before, const LiveRecord& after);

  // Returns whether rays of both may have the same paths at all.
  bool shares_rays() const { return shares_rays_; }
  // Returns what paths of both can have in common; strata are the same where their rays are launched alike.
  const CommonParts& common() const { return common_; }
  // Returns the index before of block number `index` of the record after, where its rays have the same paths; else -1.
  int64_t kept(size_t index, int64_t begin, int64_t end) const;
  // Returns a block of the record before with the numbers that meshes and strata have after.
  LiveBlockPtr renumbered(const LiveBlockPtr& block) const;

 private:
  void match_strata();
  void match_owners();
  void add_boxes_of_other_density();
  bool has_hits_of_other_density(const PathBlock& paths) const;
  bool is_any_mirror_changed() const;
  int64_t known_block(size_t index) const;
  bool aims_alike(int64_t begin, int64_t end) const;

  const LiveRecord* before_;
  const LiveRecord& after_;
  bool shares_rays_ = false, has_same_numbers_ = true;
  CommonParts common_;
  std::vector<int> stratum_after_;       // by stratum before; -1: none
  std::vector<int> of_same_name_;        // by stratum after, the one before; -1: none
  std::vector<bool> has_other_density_;  // by mesh ID before: strata that own its echoes have other rays
  bool any_other_density_ = false;
  std::vector<FloatBox> boxes_;  // of what blocks must not have met: where the changed meshes were and are, and others
};

}  // namespace echopath
