#pragma once
// The end of Python. A thread that waits for the GIL is torn away when Python ends; in the midst of C++ this ends the
// process.
#include <pybind11/pybind11.h>

#include <optional>

#include "echopath/base/job.h"

namespace echopath::bindings {

// Marks the time that a Python thread spends in work that gives the GIL away. Made and destroyed with the GIL. When Python
// ends, all jobs under way are cancelled and their threads waited for; a thread other than the one that ends Python is ended
// (SystemExit) where it begins such work after that.
class InCore {
 public:
  explicit InCore(Job* job = nullptr);
  ~InCore();
  InCore(const InCore&) = delete;
  InCore& operator=(const InCore&) = delete;

 private:
  Job* job_;
};

// Gives the GIL away for its lifetime; the work meanwhile must not touch Python objects. For work that is over soon: other
// work goes through run_job.
class WithoutGil {
 public:
  WithoutGil() { release_.emplace(); }

 private:
  InCore in_core_;
  std::optional<pybind11::gil_scoped_release> release_;  // last: the GIL comes back first
};

// Whether this thread was asked to end because Python does.
bool is_left_behind();

// Has Python call, before it ends, what waits for the other threads.
void register_leaving();

}  // namespace echopath::bindings
