#include <pybind11/complex.h>
#include <pybind11/pybind11.h>

#include <string>

#include "call/argument.h"
#include "call/define.h"
#include "echopath/em/material.h"
#include "values/value.h"

namespace echopath::bindings {
namespace {

Layer layer(Arg<"thickness", Real> thickness, Arg<"permittivity", Complex> permittivity,
            Arg<"conductivity", Real> conductivity) {
  Layer made{*thickness, *permittivity, *conductivity};
  Material sheet;
  sheet.layers = {made};
  sheet.validate();
  return made;
}

std::string layer_text(const Layer& self) {
  const std::string conductivity =
      self.conductivity > 0 ? ", conductivity=" + std::string(py::repr(py::float_(self.conductivity))) : std::string();
  return "Layer(" + std::string(py::repr(py::float_(self.thickness))) + ", " +
         std::string(py::repr(py::cast(self.permittivity))) + conductivity + ")";
}

}  // namespace

void bind_layers(py::module_& m) {
  py::class_<Layer> type(m, "Layer", R"(One layer of a sheet (Material.layers). Cannot be changed.

thickness: m; permittivity: complex, relative, eps' - j eps'' (imaginary part <= 0); conductivity: S/m, adds to the
permittivity
Raises TypeError or ValueError naming the field, the rule and the value.)");
  define_init(type, &layer, py::arg("thickness"), py::arg("permittivity"), py::arg("conductivity") = 0.0)
      .def_readonly("thickness", &Layer::thickness, "m, across the layer")
      .def_readonly("permittivity", &Layer::permittivity, "complex, relative")
      .def_readonly("conductivity", &Layer::conductivity, "S/m")
      .def("__repr__", &layer_text);
  define_value(type);
  define_replace(type);
}

}  // namespace echopath::bindings
