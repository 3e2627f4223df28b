// What the functions of angles return.
#include <pybind11/complex.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <sstream>
#include <string>
#include <vector>

#include "array.h"
#include "echopath/spectrum/angle/angle_fft.h"
#include "echopath/spectrum/angle/beamform.h"
#include "echopath/spectrum/angle/estimate_angles.h"
#include "echopath/spectrum/angle/range_azimuth.h"

namespace echopath::bindings {
namespace {

py::ssize_t size_of(const std::vector<double>& values) { return static_cast<py::ssize_t>(values.size()); }

// Getters of arrays that live in the object itself.
template <class Type>
auto view_of(std::vector<double> Type::* member) {
  return [member](const py::object& self) { return numpy_view(self.cast<const Type&>().*member, self); };
}

// "[2, 3, 4]"
std::string text_of(const Shape& shape) {
  std::ostringstream text;
  for (const py::ssize_t size : shape) text << (text.tellp() > 0 ? ", " : "[") << size;
  return text.str() + "]";
}

Shape shape_of(const AngleSpectrum& spectrum) {
  return {size_of(spectrum.sin_elevation), size_of(spectrum.sin_azimuth), size_of(spectrum.velocity),
          size_of(spectrum.range)};
}

Shape shape_of(const BeamPower& beams) {
  Shape shape{size_of(beams.elevation), size_of(beams.azimuth), size_of(beams.velocity)};
  if (!beams.is_of_cells) shape.push_back(size_of(beams.range));
  return shape;
}

std::string text_of(const RangeAzimuth& map) {
  std::ostringstream text;
  text << "RangeAzimuth([" << map.azimuth.size() << ", " << map.range.size() << "], " << map.azimuth.front() << " to "
       << map.azimuth.back() << " rad, 0 to " << map.range.back() << " m)";
  return text.str();
}

void bind_angle_spectrum(py::module_& m) {
  py::class_<AngleSpectrum>(m, "AngleSpectrum", R"(Angle spectra with their axes; made by angle_fft.

Axes are direction cosines along the columns and rows of the array's grid: for antennas in the y-z plane
sin(azimuth) cos(elevation) and sin(elevation).)")
      .def_property_readonly(
          "values",
          [](const py::object& self) {
            const auto& spectrum = self.cast<const AngleSpectrum&>();
            return numpy_view(spectrum.values.data(), shape_of(spectrum), self);
          },
          "[elevation, azimuth, velocity, range] complex in sqrt(W), read-only; phase as at the array's centre")
      .def_property_readonly("sin_azimuth", view_of(&AngleSpectrum::sin_azimuth), "[azimuth] ascending, left positive")
      .def_property_readonly("sin_elevation", view_of(&AngleSpectrum::sin_elevation), "[elevation] ascending, up positive")
      .def_property_readonly(
          "azimuth", [](const AngleSpectrum& self) { return to_numpy(angles_of(self.sin_azimuth)); },
          "[azimuth] rad at elevation 0, arcsin of sin_azimuth; NaN beyond +-1")
      .def_property_readonly(
          "elevation", [](const AngleSpectrum& self) { return to_numpy(angles_of(self.sin_elevation)); },
          "[elevation] rad, arcsin of sin_elevation; NaN beyond +-1")
      .def_property_readonly("velocity", view_of(&AngleSpectrum::velocity), "[velocity] m/s, receding positive")
      .def_property_readonly("range", view_of(&AngleSpectrum::range), "[range] m")
      .def("__repr__", [](const AngleSpectrum& self) { return "AngleSpectrum(" + text_of(shape_of(self)) + ")"; });
}

void bind_beam_power(py::module_& m) {
  py::class_<BeamPower>(m, "BeamPower", "Power of beams with their axes; made by beamform.")
      .def_property_readonly(
          "power",
          [](const py::object& self) {
            const auto& beams = self.cast<const BeamPower&>();
            return numpy_view(beams.power.data(), shape_of(beams), self);
          },
          "[elevation, azimuth, velocity, range] in W, read-only; of cells [elevation, azimuth, cell]")
      .def_property_readonly("azimuth", view_of(&BeamPower::azimuth), "[azimuth] rad, left positive")
      .def_property_readonly("elevation", view_of(&BeamPower::elevation), "[elevation] rad, up positive")
      .def_property_readonly("velocity", view_of(&BeamPower::velocity), "[velocity] m/s, or [cell]")
      .def_property_readonly("range", view_of(&BeamPower::range), "[range] m, or [cell]")
      .def("__repr__", [](const BeamPower& self) { return "BeamPower(" + text_of(shape_of(self)) + ")"; });
}

void bind_range_azimuth_map(py::module_& m) {
  py::class_<RangeAzimuth>(m, "RangeAzimuth", "A range-azimuth map with its axes; made by range_azimuth.")
      .def_property_readonly(
          "power",
          [](const py::object& self) {
            const auto& map = self.cast<const RangeAzimuth&>();
            return numpy_view(map.power.data(), {size_of(map.azimuth), size_of(map.range)}, self);
          },
          "[azimuth, range] in W, read-only: the largest over elevation")
      .def_property_readonly("azimuth", view_of(&RangeAzimuth::azimuth), "[azimuth] rad, ascending, left positive")
      .def_property_readonly("range", view_of(&RangeAzimuth::range), "[range] m")
      .def_property_readonly("elevation", view_of(&RangeAzimuth::elevation), "[elevation] rad, of the beams")
      .def_readonly("velocity", &RangeAzimuth::velocity, "m/s, of the cells taken; None: all velocities together")
      .def("__repr__", [](const RangeAzimuth& self) { return text_of(self); });
}

void bind_estimates(py::module_& m) {
  py::class_<AngleEstimates>(m, "AngleEstimates", "Directions of echoes, arrays over all peaks; made by estimate_angles.")
      .def_property_readonly(
          "cell", [](const py::object& self) { return numpy_view(self.cast<const AngleEstimates&>().cell, self); },
          "[M] index into the cells given, ascending; the strongest peak of a cell first")
      .def_property_readonly("range", view_of(&AngleEstimates::range), "[M] m, of the cell")
      .def_property_readonly("velocity", view_of(&AngleEstimates::velocity), "[M] m/s, of the cell and its fold")
      .def_property_readonly("azimuth", view_of(&AngleEstimates::azimuth), "[M] rad, left positive")
      .def_property_readonly("elevation", view_of(&AngleEstimates::elevation), "[M] rad, up positive")
      .def_property_readonly("power", view_of(&AngleEstimates::power), "[M] W")
      .def_property_readonly(
          "points", [](const py::object& self) { return numpy_view(self.cast<const AngleEstimates&>().points, self); },
          "[M, 3] m, in the radar's frame")
      .def("__len__", [](const AngleEstimates& self) { return self.cell.size(); })
      .def("__repr__",
           [](const AngleEstimates& self) { return "AngleEstimates(" + std::to_string(self.cell.size()) + " peaks)"; });
}

}  // namespace

void bind_angle_results(py::module_& m) {
  bind_angle_spectrum(m);
  bind_beam_power(m);
  bind_range_azimuth_map(m);
  bind_estimates(m);
}

}  // namespace echopath::bindings
