#pragma once
// Memory of a replay, kept for the next: the pages of a small record, touched for the first time, cost as much as its paths do.
#include <memory>
#include <mutex>
#include <vector>

#include "echopath/replay/evaluate/path_evaluator.h"
#include "echopath/replay/spare_echoes.h"

namespace echopath {

// Thread-safe.
class ReplayMemory {
 public:
  // What another left, or new; see KeptMemory.
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
