#pragma once
// Memory of a replay, kept for the next: the pages of a small record, touched for the first time, cost as much as its paths do.
#include <memory>
#include <mutex>
#include <vector>

#include "echopath/replay/direct_evaluation.h"
#include "echopath/replay/spare_echoes.h"

namespace echopath {

// Of one block at a time.
struct ReplayWorkspace {
  ChainPlanner plan_chains;
  ChainEvaluation evaluate_chains;
  DirectEvaluation evaluate_direct;
};

// Thread-safe.
class ReplayMemory {
 public:
  static constexpr size_t kMostKept = size_t{64} << 20;  // bytes, in the whole process

  // What the last replay left, or none yet.
  static std::unique_ptr<ReplayMemory> take();
  // For the next: the one that is kept; none that is larger than kMostKept.
  static void leave(std::unique_ptr<ReplayMemory> memory);

  SpareEchoes echoes;
  std::unique_ptr<ReplayWorkspace> take_workspace();
  void give(std::unique_ptr<ReplayWorkspace> workspace);

 private:
  size_t num_bytes() const;

  std::mutex mutex_;
  std::vector<std::unique_ptr<ReplayWorkspace>> workspaces_;  // not in use
};

}  // namespace echopath
