#pragma once
// Tells the progress of one long computation, and cancels it. The worker side calls `advance`; another thread may read
// `fraction` and call `cancel`. All functions are safe from any thread.
#include <algorithm>
#include <atomic>
#include <cstdint>

#include "echopath/base/errors.h"

namespace echopath {

class Job {
 public:
  Job() = default;
  // A job may be part of another one, which must outlive it: it is cancelled with that and has a progress of its own.
  explicit Job(const Job* whole) : whole_(whole) {}
  void start(int64_t total) {
    done_ = 0;
    total_ = total;
  }
  void advance(int64_t amount) { done_ += amount; }
  void cancel() { cancelled_ = true; }
  bool cancelled() const { return cancelled_ || (whole_ && whole_->cancelled()); }
  // Returns the share that is done, 0 to 1, also where `start` comes between the two numbers that tell it.
  double fraction() const {
    const int64_t total = total_;
    return total > 0 ? std::min(1.0, static_cast<double>(done_) / static_cast<double>(total)) : 0.0;
  }
  void throw_if_cancelled() const {
    if (cancelled()) throw Cancelled();
  }

 private:
  std::atomic<int64_t> done_{0}, total_{0};
  std::atomic<bool> cancelled_{false};
  const Job* whole_ = nullptr;
};

}  // namespace echopath
