#include "echopath/replay/replay_memory.h"

#include <utility>

#include "echopath/base/kept_memory.h"

namespace echopath {

std::unique_ptr<ReplayMemory> ReplayMemory::take() { return KeptMemory<ReplayMemory>::of_process().take(); }

void ReplayMemory::leave(std::unique_ptr<ReplayMemory> memory) noexcept {
  KeptMemory<ReplayMemory>::of_process().leave(std::move(memory));
}

std::unique_ptr<PathEvaluator> ReplayMemory::take_evaluator() {
  const std::lock_guard lock(mutex_);
  if (evaluators_.empty()) return std::make_unique<PathEvaluator>();
  std::unique_ptr<PathEvaluator> last = std::move(evaluators_.back());
  evaluators_.pop_back();
  return last;
}

void ReplayMemory::give(std::unique_ptr<PathEvaluator> evaluator) {
  const std::lock_guard lock(mutex_);
  evaluators_.push_back(std::move(evaluator));
}

size_t ReplayMemory::num_bytes() const {
  size_t bytes = echoes.num_bytes();
  for (const auto& evaluator : evaluators_) bytes += evaluator->num_bytes();
  return bytes;
}

}  // namespace echopath
