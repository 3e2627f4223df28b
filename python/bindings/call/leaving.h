#pragma once
// The end of Python. A thread that waits for the GIL is torn away when Python ends. In the midst of C++ this ends the
// process: what the stack holds lets go of Python objects without the GIL.
#include <pybind11/pybind11.h>

#include <optional>

#include "echopath/base/threads/job.h"

namespace echopath::bindings {

// Marks the time that a thread spends in a function of the extension, where Python code that it calls, and NumPy, may give
// the GIL away. Made and destroyed with the GIL. Before Python ends, all such calls are waited for; a thread other than the
// one that ends Python is ended (SystemExit) where it begins one after that. `define` (define.h) marks what it binds.
class InCall {
 public:
  InCall();
  ~InCall();
  InCall(const InCall&) = delete;
  InCall& operator=(const InCall&) = delete;
};

// Marks a job as under way, to be cancelled and waited for when Python ends. Made and destroyed with the GIL.
class JobUnderWay {
 public:
  explicit JobUnderWay(Job& job);
  ~JobUnderWay();
  JobUnderWay(const JobUnderWay&) = delete;
  JobUnderWay& operator=(const JobUnderWay&) = delete;

 private:
  InCall in_call_;
  Job* job_;
};

// Gives the GIL away for its lifetime; the work meanwhile must not touch Python objects. For work that is over soon: other
// work goes through run_job.
class WithoutGil {
 public:
  WithoutGil() { release_.emplace(); }

 private:
  InCall in_call_;
  std::optional<pybind11::gil_scoped_release> release_;  // last: the GIL comes back first
};

// Raises SystemExit in a thread that is still there when Python ends.
void end_if_left_behind();

// Has Python call, before it ends, what waits for the other threads.
void register_leaving();

}  // namespace echopath::bindings
