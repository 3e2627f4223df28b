#pragma once
// Long work beside Python: the caller's thread stays free for Ctrl-C and the progress callable.
#include <pybind11/pybind11.h>

#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "echopath/base/threads/job.h"

namespace echopath::bindings {

// Runs `work(job)` on a thread of its own without the GIL. Meanwhile the caller looks for signals and calls
// `progress(stage, fraction)` about 20 times a second, and once with 1.0 at the end; `progress` may be None, and True for
// the bars of echopath.base.process.progress.
// Ctrl-C and an exception of `progress` cancel the job, wait for it to end and are raised here; so is what `work` throws.
// When Python ends, the job is cancelled and this thread ended (leaving.h).
// `work` must not touch Python objects, nor a scene that Python may change meanwhile: who works on one takes it by value.
// Called with the GIL, from any thread; Python sees signals on its main one only.
void run_beside(const std::string& stage, const pybind11::object& progress, const std::function<void(Job&)>& work);

// Whether `run_beside` of this thread is looking for signals right now. A handler of signals that must not raise in the
// middle of anything else may raise then: that ends the job.
bool looks_for_signals();

// run_beside for work with a result: const Paths paths = run_job("trace", progress, [&](Job& job) { return trace(..., &job);
// });
template <class Work>
std::invoke_result_t<Work&, Job&> run_job(const std::string& stage, const pybind11::object& progress, Work&& work) {
  using Result = std::invoke_result_t<Work&, Job&>;
  if constexpr (std::is_void_v<Result>) {
    run_beside(stage, progress, work);
  } else {
    std::optional<Result> result;
    run_beside(stage, progress, [&](Job& job) { result.emplace(work(job)); });
    return std::move(*result);
  }
}

}  // namespace echopath::bindings
