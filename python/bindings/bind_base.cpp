#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <chrono>

#include "call/plausible.h"
#include "call/run_job.h"
#include "echopath/base/constants.h"
#include "echopath/base/errors.h"
#include "echopath/base/lanes/simd.h"
#include "echopath/base/text/meant_name.h"
#include "echopath/base/text/nearest_names.h"
#include "echopath/base/threads/parallel.h"

namespace echopath::bindings {
namespace {

namespace py = pybind11;

// Does nothing for that long, in steps of a millisecond: shows how long work answers, without the long work.
void wait_seconds(double seconds, const py::object& progress) {
  require(seconds >= 0.0 && seconds <= 3600.0, "seconds", "must lie in 0 to 3600", seconds);
  run_job("wait", progress, [&](Job& job) {
    const auto num_steps = static_cast<int64_t>(seconds * 1000.0);
    job.start(num_steps);
    for (int64_t i = 0; i < num_steps; ++i) {
      job.throw_if_cancelled();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      job.advance(1);
    }
  });
}

}  // namespace

void bind_base(py::module_& m) {
  m.attr("speed_of_light") = kSpeedOfLight;
  m.attr("boltzmann") = kBoltzmann;
  m.attr("reference_temperature") = kReferenceTemperature;
  m.attr("vacuum_permittivity") = kVacuumPermittivity;
  m.attr("LOWEST_FREQUENCY") = kLowestFrequency;  // Hz, of carriers
  m.attr("HIGHEST_FREQUENCY") = kHighestFrequency;

  m.def("looks_for_signals", &looks_for_signals,
        "Whether work of the core is looking for signals right now: an exception that a handler raises then ends it.");
  m.def("set_num_threads", &set_num_threads, py::arg("num_threads"), "What ep.set_num_threads calls.");
  m.def("num_threads", &num_threads, "Number of threads of the parallel loops.");
  m.def(
      "instruction_set", [] { return name_of(instruction_set()); },
      "That of the inner loops: baseline, avx2 or avx512; the environment variable ECHOPATH_INSTRUCTION_SET forces one.");
  m.def("nearest_names", &nearest_names, py::arg("word"), py::arg("candidates"), py::arg("count") = 3,
        "The candidates most like `word` by edit distance, best first, at most `count`.");
  m.def("meant_name", &meant_name, py::arg("word"), py::arg("known"),
        "The name among `known` that was most likely meant by `word`, \"\" where none is alike.");
  m.def("warn_of_turns", &warn_of_turns, py::arg("yaw"), "Warns of a yaw (rad) beyond a turn, which looks like degrees.");
  m.def("_wait", &wait_seconds, py::arg("seconds"), py::arg("progress") = py::none());
}

}  // namespace echopath::bindings
