#include <pybind11/pybind11.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "call/argument.h"
#include "call/define.h"
#include "echopath/base/range_of_coordinates.h"
#include "echopath/base/text/streamed.h"
#include "echopath/spectrum/array/steering.h"
#include "echopath/spectrum/array/virtual_array.h"
#include "values/array.h"
#include "values/travel.h"

namespace echopath::bindings {
namespace {

py::array positions_of(const VirtualArray& array) {
  py::array_t<double> flat = to_numpy(array.positions);
  return flat.reshape({py::ssize_t{array.num_transmitters}, py::ssize_t{array.num_receivers}, py::ssize_t{3}});
}

py::array element_of_channel(const VirtualArray& array) {
  std::vector<int64_t> owner(array.positions.size());
  for (size_t e = 0; e < array.elements.size(); ++e) {
    for (const int channel : array.elements[e].channels) owner[channel] = static_cast<int64_t>(e);
  }
  return numpy_take(std::move(owner), {py::ssize_t{array.num_transmitters}, py::ssize_t{array.num_receivers}});
}

py::array elements_of(const VirtualArray& array) {
  std::vector<Vec3> positions;
  for (const VirtualElement& element : array.elements) positions.push_back(element.position);
  return to_numpy(positions);
}

py::object grid_shape(const VirtualArray& array) {
  if (!array.grid) return py::none();
  return py::make_tuple(array.grid->num_rows, array.grid->num_columns);
}

py::object grid_spacing(const VirtualArray& array) {
  if (!array.grid) return py::none();
  return py::make_tuple(array.grid->row_spacing, array.grid->column_spacing);
}

py::object grid_axes(const VirtualArray& array) {
  if (!array.grid) return py::none();
  return to_numpy(std::vector<Vec3>{array.grid->row_axis, array.grid->column_axis});
}

py::object grid_index(const VirtualArray& array) {
  if (!array.grid) return py::none();
  std::vector<int64_t> index;
  for (const VirtualElement& element : array.elements) index.insert(index.end(), {element.row, element.column});
  return numpy_take(std::move(index), {std::ssize(array.elements), 2});
}

py::array gaps_of(const VirtualArray& array) {
  std::vector<int64_t> index;
  for (const auto& [row, column] : array.gaps()) index.insert(index.end(), {row, column});
  const auto count = static_cast<py::ssize_t>(index.size() / 2);
  return numpy_take(std::move(index), {count, 2});
}

py::tuple default_axes(const VirtualArray& array, Arg<"largest_step", Real> largest_step) {
  return py::make_tuple(to_numpy(default_azimuths(array, *largest_step)),
                        to_numpy(default_elevations(array, *largest_step)));
}

std::string text_of(const VirtualArray& array) {
  std::ostringstream text;
  text << "VirtualArray(" << array.num_transmitters << " x " << array.num_receivers << " channels, "
       << counted(array.elements.size(), "element");
  if (array.grid) {
    const ArrayGrid& grid = *array.grid;
    text << " on a grid of " << grid.num_rows << " x " << grid.num_columns;
    if (grid.num_rows > 1) text << ", steps of " << grid.row_spacing / array.wavelength << " wavelengths up";
    if (grid.num_columns > 1) text << ", steps of " << grid.column_spacing / array.wavelength << " wavelengths across";
    text << ", " << counted(array.gaps().size(), "gap");
  } else {
    text << " on no grid";
  }
  text << ", " << counted(array.num_overlaps(), "overlap") << ")";
  return text.str();
}

void check_and_arrange(VirtualArray& array) {
  require(array.num_transmitters >= 1, "num_transmitters", "must be at least 1", array.num_transmitters);
  require(array.num_receivers >= 1, "num_receivers", "must be at least 1", array.num_receivers);
  require(std::isfinite(array.wavelength) && array.wavelength > 0.0, "wavelength", "must be finite and positive",
          array.wavelength);
  require(std::isfinite(array.boresight), "boresight", "must be finite", array.boresight);
  require_shape(array.positions, {array.num_transmitters, array.num_receivers}, "positions");
  for (const Vec3& position : array.positions) require_in_range(position, "positions", "the antennas");
  arrange_elements(array);
}

}  // namespace

void bind_virtual_array(py::module_& m) {
  py::class_<VirtualArray> type(m, "VirtualArray", R"(Where the channels of a radar lie as one array; made by virtual_array.

Elements are ordered by row and column of their grid. A grid's rows count up and its columns count up to the left, as far
as the array's plane allows.)");
  define_no_init(type, "ep.virtual_array");
  type.def_property_readonly("positions", &positions_of, "[tx, rx, 3] m, sums of the antennas' positions")
      .def_property_readonly("elements", &elements_of, "[N, 3] m, the positions that differ by 0.01 wavelengths or more")
      .def_property_readonly("element_of_channel", &element_of_channel, "[tx, rx] index into elements")
      .def_property_readonly("num_overlaps", &VirtualArray::num_overlaps, "channels beyond the first of each element")
      .def_property_readonly("grid_shape", &grid_shape, "(rows, columns) of the grid of equal steps, or None")
      .def_property_readonly("grid_spacing", &grid_spacing, "(row, column) step in m, 0 where there is one, or None")
      .def_property_readonly("grid_axes", &grid_axes, "[2, 3] unit vectors along which rows and columns count up, or None")
      .def_property_readonly("grid_index", &grid_index, "[N, 2] row and column of each element, or None")
      .def_property_readonly(
          "grid_deviation",
          [](const VirtualArray& self) -> py::object { return self.grid ? py::cast(self.grid->deviation) : py::none(); },
          "m, largest distance of an element from its point of the grid, or None")
      .def_property_readonly(
          "tells_azimuths", &tells_azimuths,
          "whether azimuths differ: it has a horizontal extent of 0.1 wavelengths or more, and is no upright line")
      .def_property_readonly(
          "has_default_azimuths", [](const VirtualArray& self) { return has_default_azimuths(self); },
          "whether `default_angles` has azimuths: no more than 200,000 differ")
      .def_property_readonly(
          "tells_elevations", &tells_elevations,
          "whether elevations differ: it has a vertical extent of 0.1 wavelengths or more, and is no line "
          "that is more level than upright")
      .def_property_readonly("gaps", &gaps_of, "[G, 2] rows and columns of the grid without an element")
      .def_property_readonly("centre", array_of(&VirtualArray::centre), "[3] m, mean of the elements")
      .def("__repr__", [](const VirtualArray& self) { return text_of(self); });
  def_travel_checked(
      type, &check_and_arrange, attribute("num_transmitters", &VirtualArray::num_transmitters, "transmitters of the radar"),
      attribute("num_receivers", &VirtualArray::num_receivers, "receivers of the radar"),
      attribute("wavelength", &VirtualArray::wavelength, "m, at the centre frequency"),
      attribute("boresight", &VirtualArray::boresight,
                "rad, mean azimuth of the antennas' boresights in the radar's frame; 0 where they look to all sides"),
      field("positions", &VirtualArray::positions));
  define(type, "default_angles", &default_axes, py::arg("largest_step") = kPictureStep,
         R"((azimuth [A], elevation [E]) in rad: the directions that the array tells apart.

Azimuths up to +-90 degrees about the direction across the array on the side of the antennas' boresights, and elevations up to
+-45 degrees, within the unambiguous field of its grid, in steps of a quarter of wavelength / extent, or of largest_step in rad
where that is less; one alone where it tells none apart. Azimuths of antennas that look behind go on beyond pi. Raises TypeError
or ValueError naming the argument, or the angle of which there would be more than 200,000.)");
  m.def("virtual_array", &virtual_array, py::arg("radar"), "What ep.virtual_array calls.");
}

}  // namespace echopath::bindings
