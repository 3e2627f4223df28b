#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "call/argument.h"
#include "call/define.h"
#include "call/faults.h"
#include "call/leaving.h"
#include "echopath/base/text/streamed.h"
#include "echopath/scene/readers/readers.h"
#include "echopath/scene/smooth/tessellation.h"
#include "values/array.h"
#include "values/shared.h"
#include "values/value.h"

namespace echopath::bindings {
namespace {

std::shared_ptr<Mesh> mesh(Arg<"vertices", Points> vertices, Arg<"triangles", Triangles> triangles,
                           Arg<"original_triangle", Optional<VectorOf<uint32_t>>> original_triangle) {
  const WithoutGil released;
  return std::make_shared<Mesh>(*vertices, *triangles, original_triangle->value_or(std::vector<uint32_t>{}));
}

std::string mesh_text(const Mesh& self) {
  return streamed("Mesh(", self.vertices().size(), " vertices, ", counted(self.triangles().size(), "triangle"), ", ",
                  (self.is_closed() ? "closed" : "open"), ", ", self.area(), " m^2)");
}

std::shared_ptr<Mesh> part_of(const std::shared_ptr<Mesh>& self, const py::object& triangles) {
  const py::array given = array_or_none(triangles);
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
  const auto num_kept = std::ssize(self.triangles());
  std::vector<Vec3> vertices(self.num_input_vertices(), Vec3::Zero());
  for (size_t v = 0; v < self.vertices().size(); ++v) vertices[self.original_vertex()[v]] = self.vertices()[v];
  std::vector<Triangle> triangles(num_kept + self.num_removed_triangles(), Triangle{0, 0, 0});
  std::vector<uint32_t> original(triangles.size(), 0);
  for (size_t t = 0; t < self.triangles().size(); ++t) {
    for (size_t k = 0; k < 3; ++k) triangles[t][k] = self.original_vertex()[self.triangles()[t][k]];
    original[t] = self.original_triangle()[t];
  }
  return py::dict(py::arg("vertices") = to_numpy(vertices), py::arg("triangles") = to_numpy(triangles),
                  py::arg("original_triangle") = to_numpy(original));
}

py::dict keywords_of_mesh(const py::object& object) {
  const auto& self = object.cast<const Mesh&>();
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

void bind_mesh_class(py::module_& m) {
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
      .def_property_readonly("whole", shared_of(&Mesh::whole), "the Mesh that this is a part of, None for a whole")
      .def_property_readonly("whole_triangle", view_of(&Mesh::whole_triangle), "[F] triangle of `whole`, [0] for a whole")
      .def("__repr__", &mesh_text);
  define(type, "part", &part_of, py::arg("triangles"), R"(Some triangles as a mesh of their own, to be labelled.

triangles: [N] indices of triangles, or a mask [F] of bool
Returns a Mesh of these in their order. A smooth surface keeps its vertex normals across the cut, and a deformation of the
whole deforms each part. Raises ValueError for none or one out of range.)");
  define_static(type, "_part_of", &part_of_whole, py::arg("whole"), py::arg("triangles"));
  define_value(type, &keywords_of_mesh, &maker_of_mesh);
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

py::list tuples_of(const std::vector<Surfaces::Surface>& surfaces) {
  py::list tuples;
  for (const Surfaces::Surface& one : surfaces) {
    const py::object normals = one.normals.empty() ? py::object(py::none()) : to_numpy(one.normals);
    tuples.append(py::make_tuple(one.object, one.name, one.material, to_numpy(one.vertices), to_numpy(one.triangles),
                                 to_numpy(one.face), normals));
  }
  return tuples;
}

py::tuple surfaces_of_file(const std::filesystem::path& path, double unit) {
  Surfaces found;
  {
    const WithoutGil released;
    found = load_surfaces(path.string(), unit);
  }
  return py::make_tuple(tuples_of(found.surfaces), found.material_files);
}

py::tuple surfaces_of_frames(const std::vector<std::filesystem::path>& paths, double unit) {
  SurfaceFrames found;
  {
    const WithoutGil released;
    std::vector<std::string> names;
    for (const std::filesystem::path& path : paths) names.push_back(path.string());
    found = load_frames(names, unit);
  }
  py::list vertices;
  for (const std::vector<std::vector<Vec3>>& frames : found.vertices) vertices.append(to_numpy(frames));
  return py::make_tuple(tuples_of(found.surfaces), vertices);
}

std::shared_ptr<Mesh> mesh_of_file(const std::filesystem::path& path, double unit) {
  const WithoutGil released;
  return shared(load_mesh(path.string(), unit));
}

// (edge, radius, curved_area, area), or None.
std::optional<std::array<double, 4>> tessellation_of_mesh(const Mesh& mesh) {
  const WithoutGil released;
  const std::optional<Tessellation> found = tessellation_of(mesh);
  if (!found) return std::nullopt;
  return std::array<double, 4>{found->edge, found->radius, found->curved_area, found->area};
}

void bind_readers(py::module_& m) {
  m.attr("MESH_SUFFIXES") = py::tuple(py::cast(mesh_extensions()));  // of the files that these read
  m.def("load_mesh", &mesh_of_file, py::arg("path"), py::arg("unit") = 1.0, "What ep.load_mesh calls.");
  m.def("load_meshes", &meshes_of_file, py::arg("path"), py::arg("unit") = 1.0, "What ep.load_meshes calls.");
  m.def("load_surfaces", &surfaces_of_file, py::arg("path"), py::arg("unit") = 1.0,
        R"(Groups of a mesh file by material, and what its lines `mtllib` name.

Each is (object, name, name of the material, vertices [V, 3] in m, triangles [F, 3], face of the file [F], unit normals of the
corners [3 F, 3] or None where the file says nothing of them). Triangles without area are still there.)");
  m.def("load_frames", &surfaces_of_frames, py::arg("paths"), py::arg("unit") = 1.0,
        R"(Surfaces of the first of some mesh files as of load_surfaces, and vertices [T, V, 3] in m of each over all files.

Raises FileError naming a file whose faces, groups or materials are others.)");
}

}  // namespace

void bind_mesh(py::module_& m) {
  bind_mesh_class(m);
  m.def("tessellation", &tessellation_of_mesh, py::arg("mesh"), "What echopath.tracing.tessellation.tessellation calls.");
  bind_readers(m);
}

}  // namespace echopath::bindings
