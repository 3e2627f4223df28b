#include "leaving.h"

#include <chrono>
#include <optional>
#include <set>
#include <thread>

namespace echopath::bindings {
namespace {

namespace py = pybind11;

// A progress callable that never returns is not waited for: the process may then end with a message of the C++ library.
constexpr std::chrono::seconds kPatience{10};

// All of these are guarded by the GIL.
std::multiset<Job*> under_way;  // null for work that is over soon
std::optional<std::thread::id> leaving;

bool is_work_left() {
  const py::gil_scoped_release release;
  std::this_thread::sleep_for(std::chrono::milliseconds(2));
  const py::gil_scoped_acquire acquire;
  return !under_way.empty();
}

void wait_for_work() {
  leaving = std::this_thread::get_id();
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  if (under_way.empty()) return;
  do {
    for (Job* job : under_way) {
      if (job) job->cancel();
    }
  } while (is_work_left() && std::chrono::steady_clock::now() < deadline);
}

}  // namespace

bool is_left_behind() { return leaving && *leaving != std::this_thread::get_id(); }

InCore::InCore(Job* job) : job_(job) {
  if (is_left_behind()) {
    PyErr_SetNone(PyExc_SystemExit);
    throw py::error_already_set();
  }
  under_way.insert(job);
}

InCore::~InCore() { under_way.erase(under_way.find(job_)); }

void register_leaving() { py::module_::import("atexit").attr("register")(py::cpp_function(&wait_for_work)); }

}  // namespace echopath::bindings
