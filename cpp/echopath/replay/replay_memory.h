#pragma once
// Keeps the memory of a replay for the next one: for a small record, touching new pages costs as much as evaluating its
// paths.
#include <memory>
#include <mutex>
#include <vector>

#include "echopath/replay/evaluate/path_evaluator.h"
#include "echopath/replay/spare_echoes.h"

namespace echopath {

// All of its functions are thread-safe.
class ReplayMemory {
 public:
  // Returns the memory that an earlier replay left, or a new one (KeptMemory).
  static std::unique_ptr<ReplayMemory> take();
  static void leave(std::unique_ptr<ReplayMemory> memory) noexcept;

  SpareEchoes echoes;
  std::unique_ptr<PathEvaluator> take_evaluator();
  void give(std::unique_ptr<PathEvaluator> evaluator);
  size_t num_bytes() const;  // of what is not in use

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<PathEvaluator>> evaluators_;  // not in use
};

}  // namespace echopath
