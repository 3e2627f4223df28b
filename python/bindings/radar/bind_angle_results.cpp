// What the functions of angles return.
#include <pybind11/complex.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <sstream>
#include <string>

#include "call/argument.h"
#include "call/define.h"
#include "echopath/base/text/streamed.h"
#include "echopath/spectrum/angle/angle_fft.h"
#include "echopath/spectrum/angle/beamform.h"
#include "echopath/spectrum/angle/estimate_angles.h"
#include "echopath/spectrum/angle/range_azimuth.h"
#include "radar/map_plot.h"
#include "values/array.h"
#include "values/in_package.h"
#include "values/travel.h"

namespace echopath::bindings {
namespace {

// "[2, 3, 4]"
std::string text_of(const Shape& shape) {
  std::ostringstream text;
  for (const py::ssize_t size : shape) text << (text.tellp() > 0 ? ", " : "[") << size;
  return text.str() + "]";
}

Shape shape_of(const AngleSpectrum& spectrum) {
  return {std::ssize(spectrum.sin_elevation), std::ssize(spectrum.sin_azimuth), std::ssize(spectrum.velocity),
          std::ssize(spectrum.range)};
}

Shape shape_of(const BeamPower& beams) {
  Shape shape{std::ssize(beams.elevation), std::ssize(beams.azimuth), std::ssize(beams.velocity)};
  if (!beams.is_of_cells) shape.push_back(std::ssize(beams.range));
  return shape;
}

Shape shape_of(const RangeAzimuth& map) { return {std::ssize(map.azimuth), std::ssize(map.range)}; }

std::string text_of(const RangeAzimuth& map) {
  return streamed("RangeAzimuth([", map.azimuth.size(), ", ", map.range.size(), "], ", map.azimuth.front(), " to ",
                  map.azimuth.back(), " rad, 0 to ", map.range.back(), " m)");
}

void bind_angle_spectrum(py::module_& m) {
  py::class_<AngleSpectrum> bound(m, "AngleSpectrum", R"(Angle spectra with their axes; made by angle_fft.

Axes are direction cosines along the columns and rows of the array's grid: for antennas in the y-z plane
sin(azimuth) cos(elevation) and sin(elevation).)");
  define_no_init(bound, "ep.angle_fft");
  bound
      .def_property_readonly(
          "values", view_of(&AngleSpectrum::values, &shape_of),
          "[elevation, azimuth, velocity, range] complex in sqrt(W), read-only; phase as at the array's centre")
      .def_property_readonly(
          "azimuth", [](const AngleSpectrum& self) { return to_numpy(angles_of(self.sin_azimuth)); },
          "[azimuth] rad at elevation 0, arcsin of sin_azimuth; NaN beyond +-1")
      .def_property_readonly(
          "elevation", [](const AngleSpectrum& self) { return to_numpy(angles_of(self.sin_elevation)); },
          "[elevation] rad, arcsin of sin_elevation; NaN beyond +-1")
      .def("__repr__", [](const AngleSpectrum& self) { return "AngleSpectrum(" + text_of(shape_of(self)) + ")"; });
  define(bound, "to_xarray", from_package("presentation.xarray_maps", "angle_spectrum_array"),
         R"(The spectra as an xarray.DataArray, without a copy: complex values in sqrt(W).

Axes: sin_elevation, sin_azimuth (direction cosines, 1), velocity (m/s, receding positive) and range (m).

Units stand in `attrs["units"]` of values and coordinates. Needs xarray, raises ModuleNotFoundError without it.)");
  define(
      bound, "plot",
      [](const py::object& self, const py::object& range, const py::object& velocity, const py::object& ax,
         Arg<"title", Text> title) {
        return in_package("plots", "draw_angle_spectrum")(self, range, velocity, py::arg("ax") = ax,
                                                          py::arg("title") = *title);
      },
      py::arg("range") = py::none(), py::arg("velocity") = py::none(), py::kw_only(), py::arg("ax") = py::none(),
      py::arg("title") = "Received power by direction",
      R"(Draws the power by direction in one cell of the map: a curve, or a map where the array is a plane.

range: m, velocity: m/s, of the cell, the nearest is taken; None: those of the strongest cell
ax: Matplotlib axes to draw in, None: new ones; title: what stands above, the cell is added
Returns the axes: azimuth in degrees across (left positive); up power in dBm, or elevation in degrees. Raises TypeError or ValueError
naming the argument, and for a map of several cells without range and velocity.)");
  def_travel_checked(
      bound, [](const AngleSpectrum& made) { require_shape(made.values, shape_of(made), "values"); },
      array_attribute("sin_azimuth", &AngleSpectrum::sin_azimuth, "[azimuth] ascending, left positive"),
      array_attribute("sin_elevation", &AngleSpectrum::sin_elevation, "[elevation] ascending, up positive"),
      array_attribute("velocity", &AngleSpectrum::velocity, "[velocity] m/s, receding positive"),
      array_attribute("range", &AngleSpectrum::range, "[range] m"), field("values", &AngleSpectrum::values));
}

void bind_beam_power(py::module_& m) {
  py::class_<BeamPower> bound(m, "BeamPower", "Power of beams with their axes; made by beamform.");
  define_no_init(bound, "ep.beamform");
  bound
      .def_property_readonly("power", view_of(&BeamPower::power, &shape_of),
                             "[elevation, azimuth, velocity, range] in W, read-only; of cells [elevation, azimuth, cell]")
      .def("__repr__", [](const BeamPower& self) { return "BeamPower(" + text_of(shape_of(self)) + ")"; });
  def_travel_checked(
      bound, [](const BeamPower& made) { require_shape(made.power, shape_of(made), "power"); },
      array_attribute("azimuth", &BeamPower::azimuth, "[azimuth] rad, left positive"),
      array_attribute("elevation", &BeamPower::elevation, "[elevation] rad, up positive"),
      array_attribute("velocity", &BeamPower::velocity, "[velocity] m/s, or [cell]"),
      array_attribute("range", &BeamPower::range, "[range] m, or [cell]"), field("is_of_cells", &BeamPower::is_of_cells),
      field("power", &BeamPower::power));
}

void bind_range_azimuth_map(py::module_& m) {
  py::class_<RangeAzimuth> bound(m, "RangeAzimuth", "A range-azimuth map with its axes; made by range_azimuth.");
  define_no_init(bound, "ep.range_azimuth");
  bound
      .def_property_readonly("power", view_of(&RangeAzimuth::power, &shape_of),
                             "[azimuth, range] in W, read-only: the largest over elevation")
      .def("__repr__", [](const RangeAzimuth& self) { return text_of(self); });
  define(bound, "to_xarray", from_package("presentation.xarray_maps", "range_azimuth_array"),
         R"(The map as an xarray.DataArray, without a copy: power in W.

Axes: azimuth (rad, left positive) and range (m); attributes elevation (rad, of the beams) and velocity (m/s, of the cells, where
only some were taken).

Units stand in `attrs["units"]` of values and coordinates. Needs xarray, raises ModuleNotFoundError without it.)");
  define_map_plot(bound, "draw_range_azimuth", "Received power from above",
                  R"(Draws the map as a sector seen from above, the radar below, cropped to where there is signal.

ax: Matplotlib axes to draw in, None: new ones; title: what stands above the map
vmin, vmax: ends of the colour scale in dBm, None: from the noise, or 70 dB below the peak, to the peak
Returns the axes: metres to the left across (right negative), metres ahead up, in the radar's frame. Raises
TypeError or ValueError naming the argument.)");
  def_travel_checked(
      bound, [](const RangeAzimuth& made) { require_shape(made.power, shape_of(made), "power"); },
      array_attribute("azimuth", &RangeAzimuth::azimuth, "[azimuth] rad, ascending, left positive"),
      array_attribute("range", &RangeAzimuth::range, "[range] m"),
      array_attribute("elevation", &RangeAzimuth::elevation, "[elevation] rad, of the beams"),
      attribute("velocity", &RangeAzimuth::velocity, "m/s, of the cells taken; None: all velocities together"),
      field("power", &RangeAzimuth::power));
}

void bind_estimates(py::module_& m) {
  py::class_<AngleEstimates> bound(m, "AngleEstimates",
                                   "Directions of echoes, arrays over all peaks; made by estimate_angles.");
  define_no_init(bound, "ep.estimate_angles");
  bound.def("__len__", [](const AngleEstimates& self) { return self.cell.size(); })
      .def("__repr__",
           [](const AngleEstimates& self) { return "AngleEstimates(" + counted(self.cell.size(), "peak") + ")"; });
  def_travel_checked(
      bound,
      [](const AngleEstimates& made) {
        const auto count = std::ssize(made.cell);
        for (const auto* column : {&made.range, &made.velocity, &made.azimuth, &made.elevation, &made.power})
          require_shape(*column, {count}, "range, velocity, azimuth, elevation and power");
        require_shape(made.points, {count}, "points");
      },
      array_attribute("cell", &AngleEstimates::cell,
                      "[M] index into the cells given, ascending; the strongest peak of a cell first"),
      array_attribute("range", &AngleEstimates::range, "[M] m, of the cell"),
      array_attribute("velocity", &AngleEstimates::velocity, "[M] m/s, of the cell and its fold"),
      array_attribute("azimuth", &AngleEstimates::azimuth, "[M] rad, left positive"),
      array_attribute("elevation", &AngleEstimates::elevation, "[M] rad, up positive"),
      array_attribute("power", &AngleEstimates::power, "[M] W"),
      array_attribute("points", &AngleEstimates::points, "[M, 3] m, in the radar's frame"));
}

}  // namespace

void bind_angle_results(py::module_& m) {
  bind_angle_spectrum(m);
  bind_beam_power(m);
  bind_range_azimuth_map(m);
  bind_estimates(m);
}

}  // namespace echopath::bindings
