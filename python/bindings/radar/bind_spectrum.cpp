#include <pybind11/complex.h>
#include <pybind11/pybind11.h>

#include <string>

#include "call/argument.h"
#include "call/define.h"
#include "call/run_job.h"
#include "echopath/base/text/streamed.h"
#include "echopath/spectrum/array/tdm.h"
#include "echopath/spectrum/range_doppler.h"
#include "radar/cube_array.h"
#include "radar/map_plot.h"
#include "radar/window_name.h"
#include "values/array.h"
#include "values/in_package.h"
#include "values/travel.h"

namespace echopath::bindings {
namespace {

RangeDoppler range_doppler_map(const py::object& cube, const Radar& radar, const py::object& window, int zero_pad) {
  const std::vector<std::complex<double>> values = as_cube(cube, radar);
  const MapWindows taper = as_map_windows(window);
  return run_job("range_doppler", py::none(), [&](Job& job) { return range_doppler(values, radar, taper, zero_pad, &job); });
}

Shape shape_of(const RangeDoppler& map) {
  return {map.num_transmitters, map.num_receivers, std::ssize(map.velocity), std::ssize(map.range)};
}

void check_map(const RangeDoppler& map) {
  require(map.num_transmitters >= 1, "num_transmitters", "must be at least 1", map.num_transmitters);
  require(map.num_receivers >= 1, "num_receivers", "must be at least 1", map.num_receivers);
  require_shape(map.values, shape_of(map), "values");
}

std::string text_of(const RangeDoppler& map) {
  return streamed("RangeDoppler([", map.num_transmitters, ", ", map.num_receivers, ", ", map.velocity.size(), ", ",
                  map.range.size(), "], ", map.velocity.front(), " to ", map.velocity.back(), " m/s, 0 to ",
                  map.range.back(), " m)");
}

}  // namespace

void bind_spectrum(py::module_& m) {
  py::class_<RangeDoppler> bound(m, "RangeDoppler", "Range-Doppler maps with their axes; made by range_doppler.");
  define_no_init(bound, "ep.range_doppler");
  bound
      .def_property_readonly("values", view_of(&RangeDoppler::values, &shape_of),
                             "[tx, rx, velocity, range] complex in sqrt(W), read-only")
      .def_property_readonly(
          "window", [](const RangeDoppler& self) { return map_windows_value(self.window); },
          "as range_doppler takes it: a name or (\"chebyshev\", \"taylor\" or \"kaiser\", sidelobe level in dB) of both "
          "axes, "
          "or those of (range, velocity)")
      .def("__repr__", [](const RangeDoppler& self) { return text_of(self); });
  define(bound, "to_xarray", from_package("presentation.xarray_maps", "range_doppler_array"),
         R"(The map as an xarray.DataArray, without a copy: complex values in sqrt(W).

Axes: tx, rx, velocity (m/s, receding positive) and range (m).

Units stand in `attrs["units"]` of values and coordinates. Needs xarray, raises ModuleNotFoundError without it.)");
  define_map_plot(bound, "draw_range_doppler", "Received power by range and radial velocity",
                  R"(Draws the map, the mean over the channels, cropped to where there is signal.

ax: Matplotlib axes to draw in, None: new ones; title: what stands above the map
vmin, vmax: ends of the colour scale in dBm, None: from the noise, or 70 dB below the peak, to the peak
Returns the axes: range in m across, radial velocity in m/s up (receding positive). Raises TypeError or
ValueError naming the argument.)");
  define(bound, "_repr_html_", from_package("presentation.notebook", "range_doppler_html"), "A table for notebooks.");
  def_travel_checked(bound, &check_map, field("num_transmitters", &RangeDoppler::num_transmitters),
                     field("num_receivers", &RangeDoppler::num_receivers),
                     array_attribute("velocity", &RangeDoppler::velocity, "[velocity] in m/s, ascending, receding positive"),
                     array_attribute("range", &RangeDoppler::range, "[range] in m, ascending from 0"),
                     field("values", &RangeDoppler::values), field("window", &RangeDoppler::window),
                     attribute("zero_pad", &RangeDoppler::zero_pad, "of both axes"),
                     attribute("is_tdm_compensated", &RangeDoppler::is_tdm_compensated,
                               "whether compensate_tdm took out the phase between transmit slots"));

  m.def("range_doppler", &range_doppler_map, py::arg("cube"), py::arg("radar"), py::arg("window") = "hann",
        py::arg("zero_pad") = 1, "What ep.range_doppler calls.");
  m.def("check_axes", &require_axes, py::arg("spectrum"), py::arg("radar"),
        "Raises ValueError unless the axes of a range-Doppler map are those of the radar's chirps.");
  m.def(
      "window",
      [](const std::string& name, int n, std::optional<double> sidelobe_db) {
        return to_numpy(window_samples(Window::named(name, sidelobe_db), n));
      },
      py::arg("name"), py::arg("n"), py::arg("sidelobe_db") = py::none(),
      "Samples [n] of a window: cosines periodic; \"chebyshev\", \"taylor\" and \"kaiser\" symmetric, sidelobes "
      "`sidelobe_db` dB down (80, 35 and 60 if not given).");
  m.def(
      "main_lobe_half_width",
      [](const py::object& samples) { return main_lobe_half_width(as_vector<double>(samples, "samples")); },
      py::arg("samples"), "Bins from a tone to the first null of its response under a window [n], to 1/64.");
}

}  // namespace echopath::bindings
