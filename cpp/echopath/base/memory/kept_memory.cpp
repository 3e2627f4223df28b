#include "echopath/base/memory/kept_memory.h"

#include <iterator>
#include <new>
#include <utility>

namespace echopath {

KeptMemory& KeptMemory::of_process() {
  static KeptMemory& memory = *new KeptMemory;
  return memory;
}

KeptMemory::Index::iterator KeptMemory::find(std::type_index type, size_t num_bytes) {
  const auto found = index_.lower_bound({type, num_bytes, time_});
  if (found != index_.end() && found->first.type == type) return found;
  if (found == index_.begin() || std::prev(found)->first.type != type) return index_.end();
  return index_.lower_bound({type, std::prev(found)->first.num_bytes, time_});
}

KeptMemory::Memory KeptMemory::take(std::type_index type, size_t num_bytes) {
  const std::lock_guard lock(mutex_);
  const auto found = find(type, num_bytes);
  if (found == index_.end()) return {nullptr, nullptr};
  const auto piece = found->second;
  Memory memory = std::move(piece->memory);
  cost_ -= piece->cost;
  index_.erase(found);
  pieces_.erase(piece);
  return memory;
}

void KeptMemory::keep(std::type_index type, size_t num_bytes, size_t cost, Memory memory) noexcept {
  if (cost > most_) return;
  std::list<Piece> freed;  // without the lock
  const std::lock_guard lock(mutex_);
  try {
    insert({{type, num_bytes, time_ - 1}, cost, std::move(memory)});
  } catch (const std::bad_alloc&) {
    return;
  }
  while (cost_ > most_) {
    index_.erase(pieces_.front().key);
    cost_ -= pieces_.front().cost;
    freed.splice(freed.end(), pieces_, pieces_.begin());
  }
}

void KeptMemory::insert(Piece piece) {
  const Key key = piece.key;
  const size_t cost = piece.cost;
  std::list<Piece> one;
  one.push_back(std::move(piece));
  index_.emplace(key, one.begin());
  pieces_.splice(pieces_.end(), one);
  cost_ += cost;
  time_ = key.time;
}

}  // namespace echopath
