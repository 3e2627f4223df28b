// Angle spectra, beams, range-azimuth maps.
#include <pybind11/complex.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <string>

#include "call/run_job.h"
#include "call/warn.h"
#include "echopath/spectrum/angle/angle_fft.h"
#include "echopath/spectrum/angle/beamform.h"
#include "echopath/spectrum/angle/estimate_angles.h"
#include "echopath/spectrum/angle/range_azimuth.h"
#include "echopath/spectrum/array/tdm.h"
#include "radar/window_name.h"
#include "values/array.h"
#include "values/choice.h"

namespace echopath::bindings {
namespace {

constexpr auto kOverlaps = choice<Overlaps>("overlaps", "average", "first");
constexpr auto kBeamMethod = choice<BeamMethod>("method", "bartlett", "capon");
constexpr auto kCombine = choice<Combine>("combine", "sum", "peak");

// A number or [N].
std::vector<double> as_angles(const py::object& value, const char* argument) {
  const bool is_number = py::cast<py::ssize_t>(py::module_::import("numpy").attr("ndim")(value)) == 0;
  if (is_number) return as_vector<double>(value, argument, "[]");
  return as_vector<double>(value, argument);
}

BeamformOptions beams_of(const std::string& method, const py::object& window, const std::string& overlaps, bool compensate,
                         double diagonal_loading, int velocity_neighbours, int range_neighbours, bool forward_backward) {
  return {kBeamMethod.value_of(method),
          as_window(window),
          kOverlaps.value_of(overlaps),
          compensate,
          diagonal_loading,
          velocity_neighbours,
          range_neighbours,
          forward_backward};
}

// Binds call(map, radar, angles, beams, progress, extra...) with the arguments of all beams around its own.
template <class Result, class... Extra, class... Names>
void def_beams(py::module_& m, const char* name, const py::object& elevation, double step,
               Result (*call)(const RangeDoppler&, const Radar&, const AngleGrid&, const BeamformOptions&, const py::object&,
                              Extra...),
               Names... names) {
  const auto bound = [=](const RangeDoppler& map, const Radar& radar, const py::object& left, const py::object& up,
                         Extra... extra, const std::string& method, const py::object& window, const std::string& overlaps,
                         bool compensate, double loading, int velocities, int ranges, bool forward_backward,
                         const py::object& progress) {
    const VirtualArray array = virtual_array(radar);
    const AngleGrid angles{left.is_none() ? default_azimuths(array, step) : as_angles(left, "azimuth"),
                           up.is_none() ? default_elevations(array, step) : as_angles(up, "elevation")};
    const BeamformOptions beams =
        beams_of(method, window, overlaps, compensate, loading, velocities, ranges, forward_backward);
    return call(map, radar, angles, beams, progress, extra...);
  };
  const BeamformOptions standard;
  m.def(name, bound, py::arg("spectrum"), py::arg("radar"), py::arg("azimuth") = py::none(),
        py::arg("elevation") = elevation, py::kw_only(), names..., py::arg("method") = "bartlett",
        py::arg("window") = "rect", py::arg("overlaps") = "average", py::arg("compensate") = standard.compensate,
        py::arg("diagonal_loading") = standard.diagonal_loading,
        py::arg("velocity_neighbours") = standard.velocity_neighbours,
        py::arg("range_neighbours") = standard.range_neighbours, py::arg("forward_backward") = standard.forward_backward,
        py::arg("progress") = py::none(), "What the function of that name in ep calls.");
}

BeamPower beam_power(const RangeDoppler& map, const Radar& radar, const AngleGrid& angles, const BeamformOptions& beams,
                     const py::object& progress, py::object cells) {
  if (cells.is_none()) {
    return run_job("beamform", progress, [&](Job& job) { return beamform(map, radar, angles, beams, &job); });
  }
  const std::vector<Cell> chosen = as_pairs(cells, "cells");
  return run_job("beamform", progress, [&](Job& job) { return beamform(map, radar, chosen, angles, beams, &job); });
}

// What all azimuths then show is the same.
void warn_of_blindness(const Radar& radar) {
  if (tells_azimuths(virtual_array(radar))) return;
  warn_caller("range_azimuth: the antennas of this radar tell no azimuths apart (they stand in one place "
              "or one above the other): every azimuth of the map shows the same");
}

RangeAzimuth range_azimuth_map(const RangeDoppler& map, const Radar& radar, const AngleGrid& angles,
                               const BeamformOptions& beams, const py::object& progress, std::optional<double> velocity,
                               std::string combine, std::optional<std::array<double, 2>> gate) {
  const VelocityChoice choice{velocity, kCombine.value_of(combine), gate};
  warn_of_blindness(radar);
  return run_job("range_azimuth", progress,
                 [&](Job& job) { return range_azimuth(map, radar, angles, choice, beams, &job); });
}

AngleEstimates estimates(const RangeDoppler& map, const Radar& radar, const AngleGrid& angles, const BeamformOptions& beams,
                         const py::object& progress, py::object cells, py::object velocity, py::object range, int max_peaks,
                         double peak_range_db, int folds) {
  const std::vector<Cell> chosen = as_pairs(cells, "cells");
  const auto of_cells = [](const py::object& values, const char* name) {
    return values.is_none() ? std::vector<double>() : as_vector<double>(values, name);
  };
  const EstimateOptions options{
      beams, max_peaks, peak_range_db, folds, of_cells(velocity, "velocity"), of_cells(range, "range")};
  return run_job("estimate_angles", progress,
                 [&](Job& job) { return estimate_angles(map, radar, chosen, angles, options, &job); });
}

AngleSpectrum angle_spectrum(const RangeDoppler& map, const Radar& radar, const py::object& window, int zero_pad,
                             const std::string& overlaps, bool compensate, const py::object& progress) {
  const AngleFftOptions options{as_window(window), zero_pad, kOverlaps.value_of(overlaps), compensate};
  return run_job("angle_fft", progress, [&](Job& job) { return angle_fft(map, radar, options, &job); });
}

RangeDoppler compensated(const RangeDoppler& map, const Radar& radar, int fold) {
  return run_job("compensate_tdm", py::none(), [&](Job& job) { return compensate_tdm(map, radar, fold, &job); });
}

py::object slot_turns(const Radar& radar, const py::object& velocity) {
  const auto turns = to_numpy(slot_phasors(radar, as_vector<double>(velocity, "velocity")));
  return turns.attr("reshape")(radar.transmitters.size(), -1);
}

}  // namespace

void bind_angle(py::module_& m) {
  m.def("compensate_tdm", &compensated, py::arg("spectrum"), py::arg("radar"), py::arg("fold") = 0,
        "What ep.compensate_tdm calls.");
  m.def("slot_phasors", &slot_turns, py::arg("radar"), py::arg("velocity"),
        "[tx, V], which take out the phase that velocities [V] in m/s add in the slots of the transmitters.");
  m.def("angle_fft", &angle_spectrum, py::arg("spectrum"), py::arg("radar"), py::kw_only(), py::arg("window") = "hann",
        py::arg("zero_pad") = 4, py::arg("overlaps") = "average", py::arg("compensate") = true,
        py::arg("progress") = py::none(), "What ep.angle_fft calls.");
  def_beams(m, "beamform", py::float_(0.0), kPictureStep, &beam_power, py::arg("cells") = py::none());
  def_beams(m, "range_azimuth", py::float_(0.0), kPictureStep, &range_azimuth_map, py::arg("velocity") = py::none(),
            py::arg("combine") = "sum", py::arg("velocity_gate") = py::none());
  const EstimateOptions standard;
  def_beams(m, "estimate_angles", py::none(), kSearchStep, &estimates, py::arg("cells"), py::arg("velocity") = py::none(),
            py::arg("range") = py::none(), py::arg("max_peaks") = standard.max_peaks,
            py::arg("peak_range_db") = standard.peak_range_db, py::arg("folds") = standard.folds);
}

}  // namespace echopath::bindings
