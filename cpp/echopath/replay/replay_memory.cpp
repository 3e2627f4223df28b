#include "echopath/replay/replay_memory.h"

#include <utility>

namespace echopath {
namespace {

std::mutex kept_mutex;
std::unique_ptr<ReplayMemory> kept;

}  // namespace

std::unique_ptr<ReplayMemory> ReplayMemory::take() {
  {
    const std::lock_guard lock(kept_mutex);
    if (kept) return std::move(kept);
  }
  return std::make_unique<ReplayMemory>();
}

void ReplayMemory::leave(std::unique_ptr<ReplayMemory> memory) {
  if (memory->num_bytes() > kMostKept) return;
  const std::lock_guard lock(kept_mutex);
  kept.swap(memory);
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
