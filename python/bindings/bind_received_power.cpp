#include <pybind11/pybind11.h>

#include <sstream>
#include <string>

#include "array.h"
#include "echopath/replay/received_power.h"
#include "run_job.h"

namespace echopath::bindings {
namespace {

ReceivedPower power_of(const Paths& paths, int tx, int rx, const py::object& progress) {
  return run_job("received power", progress, [&](Job& job) { return received_power(paths, &job, {tx, rx}); });
}

std::string power_text(const ReceivedPower& self) {
  std::ostringstream text;
  text << "ReceivedPower(" << self.power << " W, standard_error=" << self.standard_error << " W)";
  return text.str();
}

}  // namespace

void bind_received_power(py::module_& m) {
  py::class_<ReceivedPower>(m, "ReceivedPower",
                            R"(Mean received power of a set of paths and its Monte-Carlo error; all powers in W.

At the trace time, between two antennas, at the start frequency; the mean is over the random phases of diffuse
hits. Errors come from the batches of a trace (`trace(batches=8)`) and are NaN for one batch.)")
      .def_readonly("power", &ReceivedPower::power, "W, coherent + diffuse")
      .def_readonly("standard_error", &ReceivedPower::standard_error, "W, of the power")
      .def_readonly("coherent", &ReceivedPower::coherent,
                    "W, |field|^2 of coherent paths; with batches free of bias by noise, which can take it below zero")
      .def_readonly("coherent_error", &ReceivedPower::coherent_error, "W, standard error")
      .def_readonly("diffuse", &ReceivedPower::diffuse,
                    "W, sum over diffuse hits of |field of all paths over that hit|^2")
      .def_readonly("diffuse_error", &ReceivedPower::diffuse_error, "W, standard error")
      .def_readonly("resolved", &ReceivedPower::resolved,
                    "the power is at least twice its standard error; False for one batch")
      .def_readonly("num_batches", &ReceivedPower::num_batches, "independent parts of the rays behind the errors")
      .def_property_readonly("error_db", &ReceivedPower::error_db,
                             "dB, 10 log10(1 + standard_error / power); infinite where not resolved")
      .def("__repr__", &power_text);
  m.def("received_power", &power_of, py::arg("paths"), py::kw_only(), py::arg("tx") = 0, py::arg("rx") = 0,
        py::arg("progress") = py::none(),
        R"(Mean received power of paths with its standard error, for the whole of a trace or any selection of it.

paths: of a trace with batches for errors; progress: callable(stage, fraction) or None
tx, rx: indices of the antennas
Returns a ReceivedPower, in W. Raises IndexError for antennas that are not there, KeyboardInterrupt on Ctrl-C.)");
}

}  // namespace echopath::bindings
