#include <pybind11/complex.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cmath>
#include <memory>
#include <string>

#include "call/argument.h"
#include "call/define.h"
#include "echopath/base/constants.h"
#include "echopath/em/surface/backscatter.h"
#include "echopath/em/surface/coherent_share.h"
#include "values/array.h"
#include "values/value.h"

namespace echopath::bindings {
namespace {

std::shared_ptr<Material> material(Arg<"conductor", Flag> conductor, Arg<"permittivity", Optional<Complex>> permittivity,
                                   Arg<"conductivity", Real> conductivity, Arg<"reflectivity", Optional<Real>> reflectivity,
                                   Arg<"layers", List<Instance<Layer>>> layers,
                                   Arg<"roughness_height", Real> roughness_height,
                                   Arg<"scattering", Optional<Real>> scattering,
                                   Arg<"cross_polarization", Real> cross_polarization, Arg<"mirror", Flag> mirror,
                                   Arg<"lobe_exponent", Count> lobe_exponent,
                                   Arg<"backscatter_share", Real> backscatter_share,
                                   Arg<"backscatter_exponent", Count> backscatter_exponent) {
  auto made = std::make_shared<Material>();
  made->conductor = *conductor;
  made->permittivity = *permittivity;
  made->conductivity = *conductivity;
  made->reflectivity = *reflectivity;
  made->layers = *layers;
  made->roughness_height = *roughness_height;
  made->scattering = *scattering;
  made->cross_polarization = *cross_polarization;
  made->mirror = *mirror;
  made->lobe_exponent = *lobe_exponent;
  made->backscatter_share = *backscatter_share;
  made->backscatter_exponent = *backscatter_exponent;
  made->validate();
  return made;
}

std::shared_ptr<Material> metal(Arg<"mirror", Flag> mirror) { return std::make_shared<Material>(Material::metal(*mirror)); }

py::tuple layers_of(const Material& self) {
  py::tuple layers(self.layers.size());
  for (size_t i = 0; i < self.layers.size(); ++i) layers[i] = self.layers[i];
  return layers;
}

py::dict fields_of(const Material& self) {
  py::dict fields;
  fields["conductor"] = self.conductor;
  fields["permittivity"] = self.permittivity;
  fields["conductivity"] = self.conductivity;
  fields["reflectivity"] = self.reflectivity;
  fields["layers"] = layers_of(self);
  fields["roughness_height"] = self.roughness_height;
  fields["scattering"] = self.scattering;
  fields["cross_polarization"] = self.cross_polarization;
  fields["mirror"] = self.mirror;
  fields["lobe_exponent"] = self.lobe_exponent;
  fields["backscatter_share"] = self.backscatter_share;
  fields["backscatter_exponent"] = self.backscatter_exponent;
  return fields;
}

py::array_t<double> backscatter(const Material& self, Arg<"grazing", VectorOf<double>> grazing,
                                Arg<"frequency", Real> frequency) {
  py::array_t<double> found(std::ssize(*grazing));
  for (size_t i = 0; i < grazing->size(); ++i) {
    const double angle = (*grazing)[i];
    require(angle >= 0 && angle <= 0.5 * kPi, "grazing", "must lie in [0, pi/2] rad", angle);
    found.mutable_data()[i] = backscatter_coefficient(self, *frequency, std::sin(angle));
  }
  return found;
}

std::string material_text(const Material& self) {
  const py::dict fields = fields_of(self), defaults = fields_of(Material{});
  std::string text;
  for (const auto& [name, value] : fields) {
    if (value.equal(defaults[name])) continue;
    text += (text.empty() ? "" : ", ") + std::string(py::str(name)) + "=" + std::string(py::repr(value));
  }
  return "Material(" + text + ")";
}

}  // namespace

void bind_material(py::module_& m) {
  py::class_<Material, std::shared_ptr<Material>> type(m, "Material", R"(What a surface does to a wave. Cannot be changed.

Exactly one of
conductor: True for a perfect conductor
permittivity: complex, relative, eps' - j eps'' (imaginary part <= 0)
reflectivity: share of power in [0, 1] that is reflected at every angle
layers: [K] ep.Layer of a sheet, from the side of the surface's normals on, through which waves pass; `mirror` must be False
and further
conductivity: S/m, adds to the permittivity
roughness_height: rms height in m (Ament), or scattering: S in [0, 1], S^2 is the diffuse share of power
cross_polarization: K in [0, 0.5], share of diffuse power that leaves in the cross polarisation (polarised traces); 0.5 is
full depolarisation, the most a reciprocal surface without a preferred axis does
mirror: True for planes larger than their Fresnel zone, which are treated by images whatever they meet; of a mesh that is no
    plane each of its planes
lobe_exponent: of the lobe of diffuse power about the direction of mirroring (Degli-Esposti 2007), a whole number up to 100;
    0: Lambert's lobe
backscatter_share: of a lobe, share in [0, 1] of what goes back to where the wave comes from; backscatter_exponent: of that
    part, up to 100, 0: as lobe_exponent
Raises TypeError or ValueError naming the field, the rule and the value.)");
  define_init(type, &material, py::kw_only(), py::arg("conductor") = false, py::arg("permittivity") = py::none(),
              py::arg("conductivity") = 0.0, py::arg("reflectivity") = py::none(), py::arg("layers") = py::tuple(),
              py::arg("roughness_height") = 0.0, py::arg("scattering") = py::none(), py::arg("cross_polarization") = 0.0,
              py::arg("mirror") = false, py::arg("lobe_exponent") = 0, py::arg("backscatter_share") = 0.0,
              py::arg("backscatter_exponent") = 0)
      .def_readonly("conductor", &Material::conductor, "bool")
      .def_readonly("permittivity", &Material::permittivity, "complex, relative, or None")
      .def_readonly("conductivity", &Material::conductivity, "S/m")
      .def_readonly("reflectivity", &Material::reflectivity, "share of power in [0, 1], or None")
      .def_property_readonly("layers", &layers_of, "tuple [K] of ep.Layer, empty unless a sheet")
      .def_readonly("roughness_height", &Material::roughness_height, "rms height in m")
      .def_readonly("scattering", &Material::scattering, "S in [0, 1], or None")
      .def_readonly("cross_polarization", &Material::cross_polarization, "K in [0, 0.5]")
      .def_readonly("mirror", &Material::mirror, "bool")
      .def_readonly("lobe_exponent", &Material::lobe_exponent, "of a directive lobe, 0: Lambert's")
      .def_readonly("backscatter_share", &Material::backscatter_share, "of the lobe, in [0, 1]")
      .def_readonly("backscatter_exponent", &Material::backscatter_exponent, "0: as lobe_exponent")
      .def("__repr__", &material_text);
  define(
      type, "backscatter", &backscatter, py::arg("grazing"), py::kw_only(), py::arg("frequency"),
      R"(Co-polar radar cross section per area of what a surface scatters back diffusely, sigma0 [N], without its coherent echo.

grazing: [N] rad in [0, pi/2], from the surface; frequency: Hz
Raises TypeError or ValueError naming the argument.)");
  define_static(type, "metal", &metal, py::arg("mirror") = false,
                "A perfect conductor; mirror: a plane larger than its Fresnel zone. Raises TypeError naming the argument.");
  define_value<Material>(type, &fields_of);
  define_replace<Material>(type, &fields_of);
  m.def("coherent_share", &coherent_share, py::arg("material"), py::arg("wavelength"),
        "What echopath.tracing.polarization.coherent_share calls.");
}

}  // namespace echopath::bindings
