#include <pybind11/complex.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "call/argument.h"
#include "call/define.h"
#include "call/leaving.h"
#include "echopath/base/constants.h"
#include "echopath/em/surface/backscatter.h"
#include "echopath/em/surface/coherent_share.h"
#include "echopath/scene/readers/readers.h"
#include "echopath/scene/smooth/tessellation.h"
#include "values/array.h"
#include "values/shared.h"
#include "values/value.h"

namespace echopath::bindings {
namespace {

// --- Material ---

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
  py::array_t<double> found(static_cast<py::ssize_t>(grazing->size()));
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
}

// --- Mesh ---

std::shared_ptr<Mesh> mesh(Arg<"vertices", Points> vertices, Arg<"triangles", Triangles> triangles,
                           Arg<"original_triangle", Optional<VectorOf<uint32_t>>> original_triangle) {
  const WithoutGil released;
  return std::make_shared<Mesh>(*vertices, *triangles, original_triangle->value_or(std::vector<uint32_t>{}));
}

std::string mesh_text(const Mesh& self) {
  std::ostringstream text;
  text << "Mesh(" << self.vertices().size() << " vertices, " << self.triangles().size() << " triangles, "
       << (self.is_closed() ? "closed" : "open") << ", " << self.area() << " m^2)";
  return text.str();
}

// A read-only view of one of the mesh's arrays.
template <class Getter>
auto view_of(Getter getter) {
  return [getter](const py::object& self) { return numpy_view((self.cast<const Mesh&>().*getter)(), self); };
}

std::shared_ptr<Mesh> part_of(const std::shared_ptr<Mesh>& self, const py::object& triangles) {
  const py::array given = py::array::ensure(triangles);
  if (!given || given.dtype().kind() != 'b') {
    return shared(Mesh::part(self, as_vector<uint32_t>(triangles, "triangles")));
  }
  const std::vector<Triangle>& all = self->triangles();
  const auto mask = checked_array<bool>(given, "triangles", "[" + std::to_string(all.size()) + "]");
  std::vector<uint32_t> taken;
  for (uint32_t t = 0; t < all.size(); ++t) {
    if (mask.data()[t]) taken.push_back(t);
  }
  return shared(Mesh::part(self, std::move(taken)));
}

// What makes the mesh again: the input, as far as it was kept. The same repair then gives the same vertices and triangles,
// and triangles without an area at the end stand for those that were removed.
py::dict keywords_of_whole(const Mesh& self) {
  const auto num_kept = static_cast<py::ssize_t>(self.triangles().size());
  std::vector<Vec3> vertices(static_cast<size_t>(self.num_input_vertices()), Vec3::Zero());
  for (size_t v = 0; v < self.vertices().size(); ++v) vertices[self.original_vertex()[v]] = self.vertices()[v];
  std::vector<Triangle> triangles(static_cast<size_t>(num_kept + self.num_removed_triangles()), Triangle{0, 0, 0});
  std::vector<uint32_t> original(triangles.size(), 0);
  for (size_t t = 0; t < self.triangles().size(); ++t) {
    for (size_t k = 0; k < 3; ++k) triangles[t][k] = self.original_vertex()[self.triangles()[t][k]];
    original[t] = self.original_triangle()[t];
  }
  return py::dict(py::arg("vertices") = to_numpy(vertices), py::arg("triangles") = to_numpy(triangles),
                  py::arg("original_triangle") = to_numpy(original));
}

py::dict keywords_of(const Mesh& self) {
  if (!self.whole()) return keywords_of_whole(self);
  return py::dict(py::arg("whole") = shared(self.whole()), py::arg("triangles") = to_numpy(self.whole_triangle()));
}

py::object maker_of_mesh(const py::dict& keywords) {
  const py::object type = py::type::of<Mesh>();
  return keywords.contains("whole") ? py::object(type.attr("_part_of")) : type;
}

std::shared_ptr<Mesh> part_of_whole(Arg<"whole", Instance<std::shared_ptr<Mesh>>> whole, const py::object& triangles) {
  return part_of(*whole, triangles);
}

void bind_mesh(py::module_& m) {
  py::class_<Mesh, std::shared_ptr<Mesh>> type(m, "Mesh", R"(One labelled surface. Cannot be changed; its arrays are views.

vertices: [V, 3] in m
triangles: [F, 3] indices of vertices
original_triangle: [F] integers, what `.original_triangle` shall name instead of the rows of `triangles`
No face is lost except those without area, which are counted in `num_removed_triangles`. Sheets that meet in a
non-manifold edge or vertex get vertices of their own there, appended to `vertices`. Vertices that no face uses are left
out. Raises TypeError or ValueError naming the argument, also for indices out of range, for a vertex of a face that is not
finite, and where no face has an area.)");
  define_init(type, &mesh, py::arg("vertices"), py::arg("triangles"), py::arg("original_triangle") = py::none())
      .def_property_readonly("vertices", view_of(&Mesh::vertices), "[V, 3] in m")
      .def_property_readonly("triangles", view_of(&Mesh::triangles), "[F, 3] indices of vertices")
      .def_property_readonly("original_triangle", view_of(&Mesh::original_triangle), "[F] face of the input or file")
      .def_property_readonly("original_vertex", view_of(&Mesh::original_vertex), "[V] vertex of the input")
      .def_property_readonly("num_input_vertices", &Mesh::num_input_vertices, "what a Deformation must have")
      .def_property_readonly("num_removed_triangles", &Mesh::num_removed_triangles, "faces without area, left out")
      .def_property_readonly("num_duplicated_vertices", &Mesh::num_duplicated_vertices, "added where sheets meet")
      .def_property_readonly("is_closed", &Mesh::is_closed, "no boundary edge, no duplicated vertex")
      .def_property_readonly("area", &Mesh::area, "m^2")
      .def_property_readonly(
          "whole", [](const Mesh& self) { return shared(self.whole()); },
          "the Mesh that this is a part of, None for a whole")
      .def_property_readonly("whole_triangle", view_of(&Mesh::whole_triangle), "[F] triangle of `whole`, [0] for a whole")
      .def("__repr__", &mesh_text);
  define(type, "part", &part_of, py::arg("triangles"), R"(Some triangles as a mesh of their own, to be labelled.

triangles: [N] indices of triangles, or a mask [F] of bool
Returns a Mesh of these in their order. A smooth surface keeps its vertex normals across the cut, and a deformation of the
whole deforms each part. Raises ValueError for none or one out of range.)");
  define_static(type, "_part_of", &part_of_whole, py::arg("whole"), py::arg("triangles"));
  define_value<Mesh>(type, &keywords_of, &maker_of_mesh);
}

py::list meshes_of_file(const std::filesystem::path& path, double unit) {
  std::vector<NamedMesh> meshes;
  {
    const WithoutGil released;
    meshes = load_meshes(path.string(), unit);
  }
  py::list result;
  for (const NamedMesh& named : meshes) result.append(py::make_tuple(named.name, shared(named.mesh)));
  return result;
}

py::tuple surfaces_of_file(const std::filesystem::path& path, double unit) {
  Surfaces found;
  {
    const WithoutGil released;
    found = load_surfaces(path.string(), unit);
  }
  py::list surfaces;
  for (const Surfaces::Surface& one : found.surfaces) {
    surfaces.append(py::make_tuple(one.name, one.material, shared(one.mesh)));
  }
  return py::make_tuple(surfaces, found.material_files);
}

std::shared_ptr<Mesh> mesh_of_file(const std::filesystem::path& path, double unit) {
  const WithoutGil released;
  return shared(load_mesh(path.string(), unit));
}

// (edge, radius, curved_area, area), or None.
std::optional<std::array<double, 4>> tessellation_of_mesh(const std::shared_ptr<Mesh>& mesh) {
  const WithoutGil released;
  const std::optional<Tessellation> found = tessellation_of(*mesh);
  if (!found) return std::nullopt;
  return std::array<double, 4>{found->edge, found->radius, found->curved_area, found->area};
}

void bind_surfaces(py::module_& m) {
  m.def("tessellation", &tessellation_of_mesh, py::arg("mesh"), "What echopath.tracing.tessellation.tessellation calls.");
  m.def("coherent_share", &coherent_share, py::arg("material"), py::arg("wavelength"),
        "What echopath.tracing.polarization.coherent_share calls.");
}

void bind_readers(py::module_& m) {
  m.def("load_mesh", &mesh_of_file, py::arg("path"), py::arg("unit") = 1.0, "What ep.load_mesh calls.");
  m.def("load_meshes", &meshes_of_file, py::arg("path"), py::arg("unit") = 1.0, "What ep.load_meshes calls.");
  m.def("load_surfaces", &surfaces_of_file, py::arg("path"), py::arg("unit") = 1.0,
        "([(name, name of the material, Mesh)], [what lines `mtllib` name]): groups of a mesh file by material.");
}

}  // namespace

void bind_scene(py::module_& m) {
  bind_material(m);
  bind_mesh(m);
  bind_surfaces(m);
  bind_readers(m);
}

}  // namespace echopath::bindings
