#include "echopath/replay/spare_echoes.h"

#include <utility>

namespace echopath {

// The smallest that will do; where there is none, the memory of the largest makes room.
Echoes SpareEchoes::take(size_t num_values) {
  Echoes echoes;
  {
    const std::lock_guard lock(mutex_);
    auto found = by_size_.lower_bound(num_values);
    if (found != by_size_.end()) echoes = std::move(found->second);
    else if (!by_size_.empty()) found = std::prev(by_size_.end());
    if (found != by_size_.end()) by_size_.erase(found);
  }
  echoes.group.clear();
  echoes.delay.resize(num_values);
  echoes.amplitude.resize(num_values);
  return echoes;
}

void SpareEchoes::give(std::span<Echoes> echoes) {
  const std::lock_guard lock(mutex_);
  for (Echoes& one : echoes) {
    const size_t size = one.delay.size();
    if (size > 0) by_size_.emplace(size, std::move(one));
  }
}

}  // namespace echopath
