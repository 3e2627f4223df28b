#include "call/run_job.h"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include "call/leaving.h"
#include "values/in_package.h"

namespace echopath::bindings {
namespace {

namespace py = pybind11;

constexpr std::chrono::milliseconds kPollInterval{50};

// A thread that runs one piece of work and keeps what it throws.
class Worker {
 public:
  Worker(const std::function<void(Job&)>& work, Job& job) : thread_([this, &work, &job] { run(work, job); }) {}

  // True when the work has ended; waits for that at most one poll interval, without the GIL.
  bool wait_a_little() {
    const py::gil_scoped_release release;
    std::unique_lock lock(mutex_);
    return ended_cv_.wait_for(lock, kPollInterval, [this] { return ended_; });
  }

  // Waits for the end without the GIL and returns what the work threw, or null.
  std::exception_ptr join() {
    const py::gil_scoped_release release;
    thread_.join();
    return failure_;
  }

 private:
  void run(const std::function<void(Job&)>& work, Job& job) {
    try {
      work(job);
    } catch (...) {
      failure_ = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    ended_ = true;
    ended_cv_.notify_one();
  }

  std::mutex mutex_;
  std::condition_variable ended_cv_;
  bool ended_ = false;
  std::exception_ptr failure_;
  std::thread thread_;  // last: it uses the others from its first moment
};

// Of each thread: handlers of signals run in the main one alone, but from Python 3.12 on others collect garbage where they
// look for signals, and finalisers give the GIL away.
thread_local bool is_looking = false;

void look_for_signals() {
  const bool before = std::exchange(is_looking, true);
  const bool has_raised = PyErr_CheckSignals() != 0;
  is_looking = before;
  if (has_raised) throw py::error_already_set();
}

void poll(const std::string& stage, const py::object& progress, double fraction) {
  look_for_signals();
  if (!progress.is_none()) progress(stage, fraction);
}

// Whom to tell how far the work is: nobody, a callable, or for True the bars of the package, closed however the work ends.
class Listener {
 public:
  explicit Listener(const py::object& progress) : told_(progress), is_ours_(progress.is(py::bool_(true))) {
    if (progress.is(py::bool_(false))) told_ = py::none();
    if (is_ours_) told_ = in_package("base.process.progress", "automatic_bars")();
    if (!told_.is_none() && !PyCallable_Check(told_.ptr()))
      throw py::type_error("progress: must be None, True or a callable (stage, fraction), got " +
                           std::string(Py_TYPE(told_.ptr())->tp_name));
  }
  ~Listener() {  // NOLINT(bugprone-exception-escape): pybind11 throws there only where it is broken itself
    if (!is_ours_) return;
    const py::error_scope pending;
    try {
      told_.attr("close")();
    } catch (py::error_already_set& error) {
      error.discard_as_unraisable("closing a progress bar");
    }
  }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  const py::object& callable() const { return told_; }

 private:
  py::object told_;
  bool is_ours_;
};

}  // namespace

bool looks_for_signals() { return is_looking; }

void run_beside(const std::string& stage, const py::object& progress, const std::function<void(Job&)>& work) {
  const Listener listener(progress);
  Job job;
  const JobUnderWay under_way(job);
  Worker worker(work, job);
  std::exception_ptr interruption;
  while (!interruption && !worker.wait_a_little()) {
    try {
      poll(stage, listener.callable(), job.fraction());
    } catch (...) {
      interruption = std::current_exception();
      job.cancel();
    }
  }
  const std::exception_ptr failure = worker.join();
  end_if_left_behind();
  if (interruption) std::rethrow_exception(interruption);
  if (failure) std::rethrow_exception(failure);
  poll(stage, listener.callable(), 1.0);
}

}  // namespace echopath::bindings
