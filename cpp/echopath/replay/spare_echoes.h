#pragma once
// Keeps the memory of echoes that are no longer needed: touching a new page costs as much as evaluating a path.
#include <map>
#include <mutex>
#include <span>
#include <vector>

#include "echopath/signal/echoes/echoes.h"

namespace echopath {

// All of its functions are thread-safe.
class SpareEchoes {
 public:
  // Returns echoes without a group and with room for `num_values` delays and amplitudes each, whose values are not set.
  Echoes take(size_t num_values);
  void give(std::span<Echoes> echoes);
  size_t num_bytes() const;  // of all that are here

 private:
  std::mutex mutex_;
  std::multimap<size_t, Echoes> by_room_;  // for delays
};

}  // namespace echopath
