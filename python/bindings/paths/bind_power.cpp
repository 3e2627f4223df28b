#include <pybind11/complex.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <string>

#include "call/define.h"
#include "call/run_job.h"
#include "echopath/base/text/streamed.h"
#include "echopath/power/received_power.h"
#include "values/array.h"
#include "values/travel.h"

namespace echopath::bindings {
namespace {

ReceivedPower power_of(const Paths& paths, int tx, int rx, const py::object& progress) {
  return run_job("received power", progress, [&](Job& job) { return received_power(paths, &job, {tx, rx}); });
}

using Groups = py::array_t<uint32_t, kAsVector>;

Sorting as_sorting(const Groups& groups, size_t num_groups) {
  return {{groups.data(), static_cast<size_t>(groups.size())}, num_groups};
}

std::vector<ReceivedPower> powers_of(const Paths& paths, const Groups& groups, size_t num_groups, int tx, int rx,
                                     const py::object& progress) {
  const Sorting sorting = as_sorting(groups, num_groups);
  return run_job("received power", progress, [&](Job& job) { return received_powers(paths, sorting, &job, {tx, rx}); });
}

py::tuple powers_of_sortings(const Paths& paths, const std::vector<std::pair<Groups, size_t>>& given,
                             const py::object& progress) {
  std::vector<Sorting> sortings;
  for (const auto& [groups, num_groups] : given) sortings.push_back(as_sorting(groups, num_groups));
  PowerAndLength of_paths;
  auto powers =
      run_job("received power", progress, [&](Job& job) { return received_powers(paths, sortings, &job, {}, &of_paths); });
  return py::make_tuple(std::move(powers), numpy_take(std::move(of_paths.power)), numpy_take(std::move(of_paths.length)));
}

std::string power_text(const ReceivedPower& self) {
  return streamed("ReceivedPower(", self.power, " W, 95 % in [", self.low, ", ", self.high, "] W",
                  self.resolved() ? ")" : ", not resolved)");
}

}  // namespace

void bind_power(py::module_& m) {
  py::class_<ReceivedPower> bound(m, "ReceivedPower",
                                  R"(Mean received power of a set of paths and how well the rays know it; all powers in W.

At the trace time, between two antennas, at the start frequency; the mean is over the random phases of diffuse
hits. [low, high] is the 95 % interval, of bias and chance together: what the footprint filter takes away, told by what
half the density of rays would take, and the spread of the batches or, of one batch, of the hits. The power is resolved if it
reaches no further than 0.3 dB to either side. Standard errors come from the batches of a trace (`trace(batches=8)`) alone
and are NaN for one batch.)");
  define_no_init(bound, "ep.received_power");
  bound
      .def_property_readonly("resolved", &ReceivedPower::resolved,
                             "the interval reaches no further than 0.3 dB to either side")
      .def_property_readonly("interval_db", &ReceivedPower::interval_db,
                             "dB, half the interval, the larger one of its sides; infinite where it reaches down to nothing")
      .def_property_readonly(
          "error_db", &ReceivedPower::error_db,
          "dB, 10 log10(1 + standard_error / power); infinite of one batch, which has no standard error, and where "
          "that is more than half the power")
      .def("__repr__", &power_text);
  def_travel(
      bound, attribute("power", &ReceivedPower::power, "W, coherent + diffuse"),
      attribute("standard_error", &ReceivedPower::standard_error, "W, of the power"),
      attribute("coherent", &ReceivedPower::coherent,
                "W, |field|^2 of coherent paths; with batches free of bias by noise, which can take it below zero"),
      attribute("coherent_error", &ReceivedPower::coherent_error, "W, standard error"),
      attribute("diffuse", &ReceivedPower::diffuse, "W, sum over diffuse hits of |field of all paths over that hit|^2"),
      attribute("diffuse_error", &ReceivedPower::diffuse_error, "W, standard error"),
      attribute("low", &ReceivedPower::low, "W, lower end of the 95 % interval, of bias and chance together"),
      attribute("high", &ReceivedPower::high, "W, upper end of it"),
      attribute("bias", &ReceivedPower::bias, "W, that finer launch cells may add to the coherent power"),
      attribute("bias_of_rays", &ReceivedPower::bias_of_rays,
                "W, the part of it that more rays mend: not what facets that stray from a smooth surface leave open, and "
                "edges behind other bounces"),
      attribute("chance", &ReceivedPower::chance, "W, standard error; of one batch estimated from the record"),
      attribute("field", &ReceivedPower::field, "sqrt(W), sum of the coherent paths as they arrive"),
      attribute("half_density_field", &ReceivedPower::half_density_field,
                "sqrt(W), the same through the footprint filter of launch cells sqrt(2) wider"),
      attribute("unfiltered", &ReceivedPower::unfiltered, "W, sum of |a|^2 of the coherent paths without the filter"),
      attribute("between_rays", &ReceivedPower::between_rays,
                "W, coherent power that launch cells may hold between rays: of points of reflection and of edges"),
      attribute("num_coherent_paths", &ReceivedPower::num_coherent_paths, "number of coherent paths"),
      attribute("num_diffuse_hits", &ReceivedPower::num_diffuse_hits, "number of diffuse hits"),
      attribute("strongest_share", &ReceivedPower::strongest_share, "share of the diffuse power of its strongest hit"),
      attribute("num_batches", &ReceivedPower::num_batches, "independent parts of the rays behind the errors"));
  m.def("received_power", &power_of, py::arg("paths"), py::kw_only(), py::arg("tx") = 0, py::arg("rx") = 0,
        py::arg("progress") = py::none(), "What ep.received_power calls.");
  m.def("received_powers", &powers_of, py::arg("paths"), py::arg("group_of_path"), py::arg("num_groups"), py::kw_only(),
        py::arg("tx") = 0, py::arg("rx") = 0, py::arg("progress") = py::none(), "What ep.received_powers calls.");
  m.def("received_powers_of_sortings", &powers_of_sortings, py::arg("paths"), py::arg("sortings"),
        py::arg("progress") = py::none(),
        "received_powers of several (group_of_path, num_groups) in one pass: (list [sorting, group] of ReceivedPower in W, "
        "power [P] in W, length [P] in m), the last two of each path at the trace time for the first antennas.");
}

}  // namespace echopath::bindings
