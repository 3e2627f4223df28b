#include "echopath/trace/strata/ray_owners.h"

#include <algorithm>

namespace echopath {

void RayOwners::assign(int object, MirrorSequence sequence, int stratum) {
  if (sequence == kNoMirrors) {
    direct_[object] = stratum;
    return;
  }
  const std::pair<MirrorSequence, int> entry{sequence, stratum};
  over_mirrors_[object].insert(std::ranges::lower_bound(over_mirrors_[object], entry), entry);
}

int RayOwners::owner_over_mirrors(size_t object, MirrorSequence sequence) const {
  const auto& owners = over_mirrors_[object];
  const auto found = std::ranges::lower_bound(owners, sequence, {}, &std::pair<MirrorSequence, int>::first);
  return found != owners.end() && found->first == sequence ? found->second : field_of_view_;
}

std::vector<std::pair<MirrorSequence, int>> RayOwners::strata_of(uint32_t mesh_id) const {
  const int object = object_of_mesh_.empty() ? -1 : object_of_mesh_[mesh_id];
  if (object < 0) return {};
  std::vector<std::pair<MirrorSequence, int>> strata{{kNoMirrors, direct_[object]}};
  const auto& over_mirrors = over_mirrors_[object];
  strata.insert(strata.end(), over_mirrors.begin(), over_mirrors.end());
  return strata;
}

}  // namespace echopath
