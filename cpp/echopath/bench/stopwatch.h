#pragma once
// Counts the seconds since it was made: by the clock, and of all processors together, which other programs disturb less.
#include <ctime>

namespace echopath {

class Stopwatch {
 public:
  double elapsed() const { return now(CLOCK_MONOTONIC) - elapsed_; }
  double processor() const { return now(CLOCK_PROCESS_CPUTIME_ID) - processor_; }

 private:
  static double now(clockid_t clock) {
    timespec time;
    clock_gettime(clock, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

  double elapsed_ = now(CLOCK_MONOTONIC), processor_ = now(CLOCK_PROCESS_CPUTIME_ID);
};

}  // namespace echopath
