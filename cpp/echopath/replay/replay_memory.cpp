#include "echopath/replay/replay_memory.h"

#include <utility>

#include "echopath/base/kept_memory.h"

namespace echopath {

std::unique_ptr<ReplayMemory> ReplayMemory::take() { return KeptMemory<ReplayMemory>::of_process().take(); }

void ReplayMemory::leave(std::unique_ptr<ReplayMemory> memory) noexcept {
  KeptMemory<ReplayMemory>::of_process().leave(std::move(memory));
}

std::unique_ptr<ReplayWorkspace> ReplayMemory::take_workspace() {
  const std::lock_guard lock(mutex_);
  if (workspaces_.empty()) return std::make_unique<ReplayWorkspace>();
  std::unique_ptr<ReplayWorkspace> last = std::move(workspaces_.back());
  workspaces_.pop_back();
  return last;
}

void ReplayMemory::give(std::unique_ptr<ReplayWorkspace> workspace) {
  const std::lock_guard lock(mutex_);
  workspaces_.push_back(std::move(workspace));
}

size_t ReplayMemory::num_bytes() const {
  size_t bytes = echoes.num_bytes();
  for (const auto& workspace : workspaces_) {
    bytes += workspace->evaluate_chains.num_bytes() + workspace->evaluate_direct.num_bytes();
  }
  return bytes;
}

}  // namespace echopath
