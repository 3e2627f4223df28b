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
#include "values/keywords.h"
#include "values/value.h"

namespace echopath::bindings {
namespace {

using MaterialKeywords = ListOfKeywords<
    Material, Keyword<"conductor", &Material::conductor, Flag, "bool">,
    Keyword<"permittivity", &Material::permittivity, Optional<Complex>, "complex, relative, or None">,
    Keyword<"conductivity", &Material::conductivity, Real, "S/m">,
    Keyword<"reflectivity", &Material::reflectivity, Optional<Real>, "share of power in [0, 1], or None">,
    Keyword<"layers", &Material::layers, List<Instance<Layer>>, "tuple [K] of ep.Layer, empty unless a sheet">,
    Keyword<"roughness_height", &Material::roughness_height, Real, "rms height in m">,
    Keyword<"scattering", &Material::scattering, Optional<Real>, "S in [0, 1], or None">,
    Keyword<"cross_polarization", &Material::cross_polarization, Real, "K in [0, 0.5]">,
    Keyword<"mirror", &Material::mirror, Flag, "bool">,
    Keyword<"lobe_exponent", &Material::lobe_exponent, Count, "of a directive lobe, 0: Lambert's">,
    Keyword<"backscatter_share", &Material::backscatter_share, Real, "of the lobe, in [0, 1]">,
    Keyword<"backscatter_exponent", &Material::backscatter_exponent, Count, "0: as lobe_exponent">>;
static_assert(MaterialKeywords::is_whole(), "each member of Material needs its line");

std::shared_ptr<Material> metal(Arg<"mirror", Flag> mirror) { return std::make_shared<Material>(Material::metal(*mirror)); }

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

std::string material_text(const py::object& self) {
  const py::dict fields = keywords_by_attribute<Material>(self);
  const py::dict defaults = keywords_by_attribute<Material>(py::cast(Material{}));
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
  define_members(type, MaterialKeywords{}, [](const Material& made) { made.validate(); });
  type.def("__repr__", &material_text);
  define(
      type, "backscatter", &backscatter, py::arg("grazing"), py::kw_only(), py::arg("frequency"),
      R"(Co-polar radar cross section per area of what a surface scatters back diffusely, sigma0 [N], without its coherent echo.

grazing: [N] rad in [0, pi/2], from the surface; frequency: Hz
Raises TypeError or ValueError naming the argument.)");
  define_static(type, "metal", &metal, py::arg("mirror") = false,
                "A perfect conductor; mirror: a plane larger than its Fresnel zone. Raises TypeError naming the argument.");
  define_value(type);
  define_replace(type);
  m.def("coherent_share", &coherent_share, py::arg("material"), py::arg("wavelength"),
        "What echopath.tracing.polarization.coherent_share calls.");
}

}  // namespace echopath::bindings
