#pragma once
// Keeps results that are costly to make for those who ask for the same again.
#include <algorithm>
#include <cstddef>
#include <list>
#include <mutex>
#include <optional>
#include <utility>

namespace echopath {

// Keeps the last few of them. It is thread-safe.
template <class Key, class Result>
class RecentResults {
 public:
  explicit RecentResults(size_t most) : most_(most) {}

  // Returns what was made for an equal key, or what `make` makes, for which others need not wait: they make the same
  // meanwhile.
  template <class Make>
  Result get(const Key& key, Make make) {
    if (std::optional<Result> found = find(key)) return *std::move(found);
    Result made = make();
    const std::lock_guard lock(mutex_);
    if (place_of(key) == kept_.end()) kept_.emplace_front(key, made);
    if (kept_.size() > most_) kept_.pop_back();
    return made;
  }
  size_t size() {
    const std::lock_guard lock(mutex_);
    return kept_.size();
  }

 private:
  std::optional<Result> find(const Key& key) {
    const std::lock_guard lock(mutex_);
    const auto found = place_of(key);
    if (found == kept_.end()) return std::nullopt;
    kept_.splice(kept_.begin(), kept_, found);
    return found->second;
  }

  auto place_of(const Key& key) {
    return std::ranges::find_if(kept_, [&](const auto& entry) { return entry.first == key; });
  }

  const size_t most_;
  std::mutex mutex_;
  std::list<std::pair<Key, Result>> kept_;  // the one asked for last first
};

}  // namespace echopath
