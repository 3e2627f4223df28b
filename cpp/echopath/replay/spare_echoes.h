#pragma once
// Memory of echoes that are done with, for the next: a page that is touched for the first time costs as much as a path does.
#include <map>
#include <mutex>
#include <span>
#include <vector>

#include "echopath/signal/echoes.h"

namespace echopath {

// Thread-safe.
class SpareEchoes {
 public:
  // Echoes without group and with room for that many delays and amplitudes each, which are not set.
  Echoes take(size_t num_values);
  void give(std::span<Echoes> echoes);
  size_t num_bytes() const;  // of all that are here

 private:
  std::mutex mutex_;
  std::multimap<size_t, Echoes> by_room_;  // for delays
};

}  // namespace echopath
