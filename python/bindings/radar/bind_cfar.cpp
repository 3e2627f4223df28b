// Detection at a constant false-alarm rate.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "call/define.h"
#include "call/run_job.h"
#include "echopath/base/text/streamed.h"
#include "echopath/spectrum/cfar/peaks.h"
#include "values/array.h"
#include "values/choice.h"
#include "values/travel.h"

namespace echopath::bindings {
namespace {

constexpr auto kCfarMethod = choice<CfarMethod>("method", "ca", "os", "go", "so");

// Binds call(map, radar, options, extra...) with the settings of a design before its own arguments.
template <class Result, class... Extra, class... Names>
void def_cfar(py::module_& m, const char* name, const char* doc,
              Result (*call)(const RangeDoppler&, const Radar&, CfarOptions, Extra...), Names... names) {
  const CfarOptions standard;
  m.def(
      name,
      [call](const RangeDoppler& map, const Radar& radar, const std::string& method, double false_alarm_rate,
             std::optional<int> guard_velocity, std::optional<int> guard_range, std::optional<int> training_velocity,
             std::optional<int> training_range, double rank, bool beams, Extra... extra) {
        return call(map, radar,
                    {kCfarMethod.value_of(method), false_alarm_rate, guard_velocity, guard_range, training_velocity,
                     training_range, rank, beams},
                    extra...);
      },
      py::arg("spectrum"), py::arg("radar"), py::kw_only(), py::arg("method") = "ca",
      py::arg("false_alarm_rate") = standard.false_alarm_rate, py::arg("guard_velocity") = py::none(),
      py::arg("guard_range") = py::none(), py::arg("training_velocity") = py::none(), py::arg("training_range") = py::none(),
      py::arg("rank") = standard.rank, py::arg("beams") = standard.beams, names..., doc);
}

CfarResult cfar_of(const RangeDoppler& map, const Radar& radar, CfarOptions options, std::vector<double> noise_shape,
                   py::object progress) {
  options.noise_shape = std::move(noise_shape);
  return run_job("cfar", progress, [&](Job& job) { return cfar(map, radar, options, &job); });
}

void check_cfar(const RangeDoppler& map, const Radar& radar, CfarOptions options) { cfar_design(map, radar, options); }

py::array_t<bool> mask_of(const CfarResult& result) {
  py::array_t<bool> mask({result.num_velocities, result.num_ranges});
  std::fill_n(mask.mutable_data(), mask.size(), false);
  for (const auto& [velocity, range] : result.cells) mask.mutable_at(velocity, range) = true;
  return mask;
}

py::dict peaks_of(const RangeDoppler& map, const Radar& radar, const CfarResult& found, const py::object& progress) {
  Peaks peaks = run_job("find_peaks", progress, [&](Job& job) { return find_peaks(map, radar, found, &job); });
  py::dict out;
  out["beam_weights"] = py::none();
  if (found.num_beams > 0) {
    const Shape channels = {std::ssize(peaks.cells), map.num_transmitters, map.num_receivers};
    out["beam_weights"] = numpy_take(std::move(peaks.beam_weights), channels);
  }
  out["cells"] = to_numpy(peaks.cells);
  out["velocity"] = numpy_take(std::move(peaks.velocity));
  out["range"] = numpy_take(std::move(peaks.range));
  out["power"] = numpy_take(std::move(peaks.power));
  out["noise"] = numpy_take(std::move(peaks.noise));
  out["velocity_offset"] = numpy_take(std::move(peaks.velocity_offset));
  out["range_offset"] = numpy_take(std::move(peaks.range_offset));
  return out;
}

std::string text_of(const CfarResult& result) {
  const CfarWindow& cells = result.design.cells;
  return streamed("CfarResult(", result.cells.size(), " of ", result.num_velocities, " x ", result.num_ranges,
                  " cells, method '", kCfarMethod.name_of(result.design.method), "', false_alarm_rate ",
                  result.design.false_alarm_rate, ", guard ", cells.guard_velocity, " x ", cells.guard_range, ", training ",
                  cells.training_velocity, " x ", cells.training_range, ")");
}

Shape shape_of(const CfarResult& result) { return {result.num_velocities, result.num_ranges}; }

void check_result(const CfarResult& made) {
  require_shape(made.power, shape_of(made), "power");
  require_shape(made.noise, {std::ssize(made.cells)}, "noise");
  require(made.num_beams >= 0, "num_beams", "must not be negative", made.num_beams);
  require(std::ssize(made.beams) == (made.num_beams == 0 ? 0 : std::ssize(made.cells)), "beams",
          "must be one for each cell, or none where channels were summed", made.beams.size());
  for (const auto& [velocity, range] : made.cells) {
    require(velocity >= 0 && velocity < made.num_velocities, "cells", "must lie in the map", velocity);
    require(range >= 0 && range < made.num_ranges, "cells", "must lie in the map", range);
  }
  require(!made.factors.factor.empty(), "factors", "must not be empty", 0);
}

// Fields of the parts of a result.
auto in_design(const char* name, auto CfarDesign::* member) {
  return field(name, [member](auto& self) -> auto& { return self.design.*member; });
}
auto in_window(const char* name, int CfarWindow::* member) {
  return field(name, [member](auto& self) -> auto& { return self.design.cells.*member; });
}
auto in_noise(const char* name, auto MapNoise::* member) {
  return field(name, [member](auto& self) -> auto& { return self.design.noise.*member; });
}

void def_cfar_travel(py::class_<CfarResult>& bound) {
  def_travel_checked(bound, &check_result,
                     field(
                         "method", [](auto& self) -> auto& { return self.design.method; }, kCfarMethod),
                     in_design("false_alarm_rate", &CfarDesign::false_alarm_rate), in_design("rank", &CfarDesign::rank),
                     in_window("guard_velocity", &CfarWindow::guard_velocity),
                     in_window("guard_range", &CfarWindow::guard_range),
                     in_window("training_velocity", &CfarWindow::training_velocity),
                     in_window("training_range", &CfarWindow::training_range), in_noise("window", &MapNoise::window),
                     in_noise("num_chirps", &MapNoise::num_chirps), in_noise("num_samples", &MapNoise::num_samples),
                     in_noise("zero_pad", &MapNoise::zero_pad), in_noise("num_channels", &MapNoise::num_channels),
                     field("factors", [](auto& self) -> auto& { return self.factors.factor; }),
                     field("statistic", [](auto& self) -> auto& { return self.factors.statistic; }),
                     field("num_velocities", &CfarResult::num_velocities), field("num_ranges", &CfarResult::num_ranges),
                     field("power", &CfarResult::power), field("cells", &CfarResult::cells),
                     field("beams", &CfarResult::beams), field("num_beams", &CfarResult::num_beams),
                     array_attribute("noise", &CfarResult::noise,
                                     "[D] W, mean power of the noise about each cell found, as its training cells tell it"));
}

}  // namespace

void bind_cfar(py::module_& m) {
  py::class_<CfarResult> bound(m, "CfarResult", "Cells of a range-Doppler map that exceed their thresholds; made by cfar.");
  define_no_init(bound, "ep.cfar");
  bound
      .def_property_readonly("power", view_of(&CfarResult::power, &shape_of),
                             "[velocity, range] W, mean over channels; with beams that of the strongest")
      .def_property_readonly("mask", &mask_of, "[velocity, range] bool, true in the cells found")
      .def_property_readonly("cells", array_of(&CfarResult::cells),
                             "[D, 2] (velocity, range) indices of the cells found, ascending")
      .def_property_readonly(
          "factor", [](const CfarResult& self) { return self.factors.factor.back() * self.factors.statistic; },
          "power over noise, linear, from which a cell away from the ends of the range axis is found, in a beam where these "
          "are")
      .def_readonly("num_beams", &CfarResult::num_beams, "in which each cell was tested, 0: its channels were summed")
      .def_property_readonly(
          "method", [](const CfarResult& self) { return kCfarMethod.name_of(self.design.method); },
          "\"ca\", \"os\", \"go\" or \"so\"")
      .def_property_readonly(
          "false_alarm_rate", [](const CfarResult& self) { return self.design.false_alarm_rate; }, "of one cell")
      .def_property_readonly(
          "guard",
          [](const CfarResult& self) {
            return py::make_tuple(self.design.cells.guard_velocity, self.design.cells.guard_range);
          },
          "half widths along (velocity, range) in cells")
      .def_property_readonly(
          "training",
          [](const CfarResult& self) {
            return py::make_tuple(self.design.cells.training_velocity, self.design.cells.training_range);
          },
          "cells beyond the guard cells on each side, along (velocity, range)")
      .def("__len__", [](const CfarResult& self) { return self.cells.size(); })
      .def("__repr__", [](const CfarResult& self) { return text_of(self); });
  def_cfar_travel(bound);

  def_cfar(m, "cfar", "What ep.cfar calls.", &cfar_of, py::arg("noise_shape") = std::vector<double>(),
           py::arg("progress") = py::none());
  def_cfar(m, "check_cfar", "Raises what cfar would for these settings, at no cost.", &check_cfar);
  m.def("check_beams", &check_beams, py::arg("radar"), py::arg("false_alarm_rate"),
        "Raises what cfar would in the beams of this radar, at no cost.");
  m.def("find_peaks", &peaks_of, py::arg("spectrum"), py::arg("radar"), py::arg("found"), py::arg("progress") = py::none(),
        R"(Local maxima among the cells found, and where between the cells they lie.

found: CfarResult of that spectrum [tx, rx, velocity, range]; progress: callable(stage, fraction) or None
Returns a dict of arrays [N]: cells [N, 2], velocity (m/s), range (m, as the map shows it), power and noise (W, mean over
channels, or of the beam that found the cell), velocity_offset, range_offset (cells); and beam_weights [N, tx, rx], whose sum
with the values of a cell is the field of the beam that found it, or None without beams. Raises ValueError.)");
}

}  // namespace echopath::bindings
