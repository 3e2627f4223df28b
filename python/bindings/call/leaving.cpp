#include "call/leaving.h"

#include <chrono>
#include <set>
#include <thread>

namespace echopath::bindings {
namespace {

namespace py = pybind11;

// A progress callable that never returns is not waited for: the process may then end with a message of the C++ library.
constexpr std::chrono::seconds kPatience{10};

// All of these are guarded by the GIL.
size_t num_calls = 0;
std::set<Job*> under_way;
std::optional<std::thread::id> leaving;

bool is_call_left() {
  const py::gil_scoped_release release;
  std::this_thread::sleep_for(std::chrono::milliseconds(2));
  const py::gil_scoped_acquire acquire;
  return num_calls > 0;
}

void wait_for_calls() {
  leaving = std::this_thread::get_id();
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  if (num_calls == 0) return;
  do {
    for (Job* job : under_way) job->cancel();
  } while (is_call_left() && std::chrono::steady_clock::now() < deadline);
}

}  // namespace

void end_if_left_behind() {
  if (!leaving || *leaving == std::this_thread::get_id()) return;
  PyErr_SetNone(PyExc_SystemExit);
  throw py::error_already_set();
}

InCall::InCall() {
  end_if_left_behind();
  ++num_calls;
}

InCall::~InCall() { --num_calls; }

JobUnderWay::JobUnderWay(Job& job) : job_(&job) { under_way.insert(job_); }

JobUnderWay::~JobUnderWay() { under_way.erase(job_); }

void register_leaving() { py::module_::import("atexit").attr("register")(py::cpp_function(&wait_for_calls)); }

}  // namespace echopath::bindings
