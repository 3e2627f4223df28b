#include "echopath/replay/spare_echoes.h"

#include <utility>

namespace echopath {

// Takes the smallest memory that suffices; where none does, it frees the largest and takes new memory.
Echoes SpareEchoes::take(size_t num_values) {
  Echoes echoes;
  {
    const std::lock_guard lock(mutex_);
    auto found = by_room_.lower_bound(num_values);
    if (found != by_room_.end()) echoes = std::move(found->second);
    else if (!by_room_.empty()) found = std::prev(by_room_.end());
    if (found != by_room_.end()) by_room_.erase(found);
  }
  echoes.group.clear();
  echoes.sampling = {};
  echoes.delay.resize(num_values);
  echoes.amplitude.resize(num_values);
  return echoes;
}

void SpareEchoes::give(std::span<Echoes> echoes) {
  const std::lock_guard lock(mutex_);
  for (Echoes& one : echoes) {
    const size_t room = one.delay.capacity();  // its size is that of the paths that were followed
    if (room > 0) by_room_.emplace(room, std::move(one));
  }
}

size_t SpareEchoes::num_bytes() const {
  size_t values = 0;
  for (const auto& [room, echoes] : by_room_) values += room;
  return values * (sizeof(double) + sizeof(std::complex<double>));
}

}  // namespace echopath
