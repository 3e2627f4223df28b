#include <pybind11/complex.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "array.h"
#include "echopath/scene/overlap/coplanar.h"
#include "echopath/scene/readers/readers.h"
#include "echopath/scene/scene.h"
#include "keywords.h"
#include "leaving.h"
#include "run_job.h"

namespace echopath::bindings {
namespace {

// pybind11 has no holder of const objects; what is handed out has no way to change it.
template <class T>
std::shared_ptr<T> shared(const std::shared_ptr<const T>& pointer) {
  return std::const_pointer_cast<T>(pointer);
}

double as_number(const py::object& value, const char* argument) {
  return *checked_array<double>(value, argument, "[]").data();
}

bool as_bool(const py::object& value, const char* argument) { return *checked_array<bool>(value, argument, "[]").data(); }

std::optional<double> as_optional_number(const py::object& value, const char* argument) {
  return value.is_none() ? std::nullopt : std::optional<double>(as_number(value, argument));
}

// --- Material ---

const std::vector<std::string> kMaterialFields = {"conductor",        "permittivity", "conductivity",       "reflectivity",
                                                  "roughness_height", "scattering",   "cross_polarization", "mirror"};

std::shared_ptr<Material> material(const py::object& conductor, const py::object& permittivity,
                                   const py::object& conductivity, const py::object& reflectivity,
                                   const py::object& roughness_height, const py::object& scattering,
                                   const py::object& cross_polarization, const py::object& mirror,
                                   const py::kwargs& unknown) {
  refuse_unknown(unknown, "Material", kMaterialFields);
  auto made = std::make_shared<Material>();
  made->conductor = as_bool(conductor, "conductor");
  if (!permittivity.is_none()) {
    made->permittivity = *checked_array<std::complex<double>>(permittivity, "permittivity", "[]").data();
  }
  made->conductivity = as_number(conductivity, "conductivity");
  made->reflectivity = as_optional_number(reflectivity, "reflectivity");
  made->roughness_height = as_number(roughness_height, "roughness_height");
  made->scattering = as_optional_number(scattering, "scattering");
  made->cross_polarization = as_number(cross_polarization, "cross_polarization");
  made->mirror = as_bool(mirror, "mirror");
  made->validate();
  return made;
}

py::dict fields_of(const Material& self) {
  py::dict fields;
  fields["conductor"] = self.conductor;
  fields["permittivity"] = self.permittivity;
  fields["conductivity"] = self.conductivity;
  fields["reflectivity"] = self.reflectivity;
  fields["roughness_height"] = self.roughness_height;
  fields["scattering"] = self.scattering;
  fields["cross_polarization"] = self.cross_polarization;
  fields["mirror"] = self.mirror;
  return fields;
}

py::object replaced(const Material& self, const py::kwargs& changes) {
  py::dict fields = fields_of(self);
  for (const auto& [name, value] : changes) fields[name] = value;
  return py::type::of<Material>()(**fields);
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
  py::class_<Material, std::shared_ptr<Material>>(m, "Material", R"(What a surface does to a wave. Cannot be changed.

Exactly one of
conductor: True for a perfect conductor
permittivity: complex, relative, eps' - j eps'' (imaginary part <= 0)
reflectivity: share of power in [0, 1] that is reflected at every angle
and further
conductivity: S/m, adds to the permittivity
roughness_height: rms height in m (Ament), or scattering: S in [0, 1], S^2 is the diffuse share of power
cross_polarization: K in [0, 0.5], share of diffuse power that leaves in the cross polarisation (polarised traces); 0.5 is
full depolarisation, the most a reciprocal surface without a preferred axis does
mirror: True for a plane larger than its Fresnel zone, which is treated by images
Raises ValueError naming the field, the rule and the value.)")
      .def(py::init(&material), py::kw_only(), py::arg("conductor") = false, py::arg("permittivity") = py::none(),
           py::arg("conductivity") = 0.0, py::arg("reflectivity") = py::none(), py::arg("roughness_height") = 0.0,
           py::arg("scattering") = py::none(), py::arg("cross_polarization") = 0.0, py::arg("mirror") = false)
      .def_static(
          "metal", [](bool mirror) { return std::make_shared<Material>(Material::metal(mirror)); },
          py::arg("mirror") = false, "A perfect conductor; mirror: a plane larger than its Fresnel zone.")
      .def("replace", &replaced, "A copy with some fields changed: material.replace(mirror=True).")
      .def_readonly("conductor", &Material::conductor, "bool")
      .def_readonly("permittivity", &Material::permittivity, "complex, relative, or None")
      .def_readonly("conductivity", &Material::conductivity, "S/m")
      .def_readonly("reflectivity", &Material::reflectivity, "share of power in [0, 1], or None")
      .def_readonly("roughness_height", &Material::roughness_height, "rms height in m")
      .def_readonly("scattering", &Material::scattering, "S in [0, 1], or None")
      .def_readonly("cross_polarization", &Material::cross_polarization, "K in [0, 0.5]")
      .def_readonly("mirror", &Material::mirror, "bool")
      .def("__eq__",
           [](const Material& self, const py::object& other) {
             return py::isinstance<Material>(other) && fields_of(self).equal(fields_of(other.cast<const Material&>()));
           })
      .def("__hash__", [](const Material& self) { return py::hash(py::tuple(fields_of(self).attr("values")())); })
      .def("__repr__", &material_text);
}

// --- Mesh ---

std::shared_ptr<Mesh> mesh(const py::object& vertices, const py::object& triangles, const py::object& original_triangle,
                           const py::kwargs& unknown) {
  refuse_unknown(unknown, "Mesh", {"vertices", "triangles", "original_triangle"});
  std::vector<Vec3> points = as_points(vertices, "vertices");
  std::vector<Triangle> corners = as_triangles(triangles, "triangles");
  std::vector<uint32_t> source;
  if (!original_triangle.is_none()) source = as_vector<uint32_t>(original_triangle, "original_triangle");
  const WithoutGil released;
  return std::make_shared<Mesh>(std::move(points), std::move(corners), std::move(source));
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

void bind_mesh(py::module_& m) {
  py::class_<Mesh, std::shared_ptr<Mesh>>(m, "Mesh", R"(One labelled surface. Cannot be changed; its arrays are views.

vertices: [V, 3] in m
triangles: [F, 3] indices of vertices
original_triangle: [F] integers, what `.original_triangle` shall name instead of the rows of `triangles`
No face is lost except those without area, which are counted in `num_removed_triangles`. Sheets that meet in a
non-manifold edge or vertex get vertices of their own there, appended to `vertices`. Vertices that no face uses are left
out. Raises ValueError for indices out of range and where no face has an area.)")
      .def(py::init(&mesh), py::arg("vertices"), py::arg("triangles"), py::arg("original_triangle") = py::none())
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
      .def("part", &part_of, py::arg("triangles"), R"(Some triangles as a mesh of their own, to be labelled.

triangles: [N] indices of triangles, or a mask [F] of bool
Returns a Mesh of these in their order. A smooth surface keeps its vertex normals across the cut, and a deformation of the
whole deforms each part. Raises ValueError for none or one out of range.)")
      .def("__repr__", &mesh_text);
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

std::shared_ptr<Mesh> mesh_of_file(const std::filesystem::path& path, double unit) {
  const WithoutGil released;
  return shared(load_mesh(path.string(), unit));
}

void bind_readers(py::module_& m) {
  m.def("load_mesh", &mesh_of_file, py::arg("path"), py::arg("unit") = 1.0, "What ep.load_mesh calls.");
  m.def("load_meshes", &meshes_of_file, py::arg("path"), py::arg("unit") = 1.0, "What ep.load_meshes calls.");
}

// --- Scene ---

Node node(std::string name, int parent, const py::object& placement, std::shared_ptr<Motion> motion,
          std::shared_ptr<Mesh> mesh, std::shared_ptr<Deformation> deformation, std::shared_ptr<Material> material,
          std::string material_name, bool smooth) {
  Node made;
  made.name = std::move(name);
  made.parent = parent;
  if (!placement.is_none()) made.placement = as_transform(placement, "transform");
  made.motion = std::move(motion);
  made.mesh = std::move(mesh);
  made.deformation = std::move(deformation);
  made.material = std::move(material);
  made.material_name = std::move(material_name);
  made.smooth = smooth;
  return made;
}

// What scene.meshes lists.
struct MeshEntry {
  uint32_t id;
  int node_index;
  Node node;
};

uint32_t checked_mesh_id(const Scene& scene, int64_t mesh_id) {
  const auto count = static_cast<int64_t>(scene.meshes().size());
  if (mesh_id >= 0 && mesh_id < count) return static_cast<uint32_t>(mesh_id);
  throw std::out_of_range("mesh_id: must lie in 0 to " + std::to_string(count - 1) + ", got " + std::to_string(mesh_id));
}

// All nodes or none.
void add_nodes(Scene& scene, const std::vector<Node>& nodes) {
  if (nodes.size() == 1) {
    scene.add(nodes.front());
    return;
  }
  Scene grown = scene;
  for (const Node& node : nodes) grown.add(node);
  scene = std::move(grown);
}

std::vector<MeshEntry> mesh_entries(const Scene& scene) {
  std::vector<MeshEntry> entries;
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) {
    entries.push_back({id, scene.meshes()[id].node, scene.node_of(id)});
  }
  return entries;
}

py::array_t<double> world_vertices_of(const Scene& scene, int64_t mesh_id, double time) {
  return to_numpy(world_vertices(scene, checked_mesh_id(scene, mesh_id), time));
}

// What scene.coplanar_overlaps lists.
struct NamedOverlap {
  CoplanarOverlap overlap;
  std::string first, second;
};

std::vector<NamedOverlap> named_overlaps(Scene scene, double time, double max_distance) {
  const auto found =
      run_job("coplanar overlaps", py::none(), [&](Job& job) { return coplanar_overlaps(scene, time, max_distance, &job); });
  std::vector<NamedOverlap> named;
  for (const CoplanarOverlap& one : found) {
    named.push_back({one, scene.node_of(one.first_mesh_id).name, scene.node_of(one.second_mesh_id).name});
  }
  return named;
}

std::string overlap_text(const NamedOverlap& self) {
  std::ostringstream text;
  text << "CoplanarOverlap('" << self.first << "', '" << self.second << "', " << self.overlap.num_triangles << " triangles, "
       << self.overlap.area << " m^2)";
  return text.str();
}

void bind_overlaps(py::module_& m) {
  py::class_<NamedOverlap>(m, "CoplanarOverlap", "Where two meshes, or a mesh and itself, lie on each other.")
      .def_property_readonly(
          "names", [](const NamedOverlap& self) { return py::make_tuple(self.first, self.second); },
          "full names of the two meshes; twice the same for a mesh that lies on itself")
      .def_property_readonly(
          "mesh_ids",
          [](const NamedOverlap& self) { return py::make_tuple(self.overlap.first_mesh_id, self.overlap.second_mesh_id); },
          "their mesh IDs, the lower one first")
      .def_property_readonly(
          "num_triangles", [](const NamedOverlap& self) { return self.overlap.num_triangles; },
          "of both meshes, that lie on one of the other")
      .def_property_readonly(
          "area", [](const NamedOverlap& self) { return self.overlap.area; }, "m^2, summed over pairs of triangles")
      .def_property_readonly(
          "distance", [](const NamedOverlap& self) { return self.overlap.distance; }, "m, largest between the two")
      .def("__repr__", &overlap_text);
}

std::string scene_text(const Scene& self) {
  return "Scene(" + std::to_string(self.nodes().size()) + " nodes, " + std::to_string(self.meshes().size()) + " meshes, " +
         std::to_string(self.num_triangles()) + " triangles)";
}

void bind_nodes(py::module_& m) {
  py::class_<Node>(m, "Node", "A node of a scene; cannot be changed.")
      .def(py::init(&node), py::kw_only(), py::arg("name"), py::arg("parent") = -1, py::arg("placement") = py::none(),
           py::arg("motion") = py::none(), py::arg("mesh") = py::none(), py::arg("deformation") = py::none(),
           py::arg("material") = py::none(), py::arg("material_name") = "", py::arg("smooth") = false)
      .def_readonly("name", &Node::name, "full name, \"street/pedestrian/head\"")
      .def_readonly("parent", &Node::parent, "index of the parent, -1 for a child of the root")
      .def_property_readonly(
          "placement", [](const Node& self) { return to_numpy(self.placement); },
          "[4, 4] at rest, relative to the parent, m")
      .def_property_readonly(
          "motion", [](const Node& self) { return shared(self.motion); }, "a motion or None")
      .def_property_readonly(
          "mesh", [](const Node& self) { return shared(self.mesh); }, "a Mesh or None")
      .def_property_readonly(
          "deformation", [](const Node& self) { return shared(self.deformation); }, "a VertexSequence, a Skin or None")
      .def_property_readonly(
          "material", [](const Node& self) { return shared(self.material); }, "a Material or None")
      .def_readonly("material_name", &Node::material_name, "as given, \"\" for a material without a name")
      .def_readonly("smooth", &Node::smooth, "whether the mesh stands for a curved surface")
      .def("__repr__", [](const Node& self) { return "Node('" + self.name + "'" + (self.mesh ? ", mesh)" : ")"); });

  py::class_<MeshEntry>(m, "SceneMesh", "A mesh of a scene with its mesh ID.")
      .def_readonly("id", &MeshEntry::id, "mesh ID")
      .def_readonly("node", &MeshEntry::node_index, "index into scene.nodes")
      .def_property_readonly(
          "name", [](const MeshEntry& self) { return self.node.name; }, "full name of its node")
      .def_property_readonly(
          "mesh", [](const MeshEntry& self) { return shared(self.node.mesh); }, "the Mesh")
      .def_property_readonly(
          "triangles",
          [](const MeshEntry& self) -> py::object { return py::cast(shared(self.node.mesh)).attr("triangles"); },
          "[F, 3] indices of vertices")
      .def_property_readonly(
          "material", [](const MeshEntry& self) { return shared(self.node.material); }, "the Material")
      .def_property_readonly(
          "material_name", [](const MeshEntry& self) { return self.node.material_name; },
          "as given, \"\" for a material without a name")
      .def("__repr__", [](const MeshEntry& self) {
        const std::string count = std::to_string(self.node.mesh->triangles().size());
        return "SceneMesh(" + std::to_string(self.id) + ", '" + self.node.name + "', " + count + " triangles)";
      });
}

void bind_scene_tree(py::module_& m) {
  py::class_<Scene, std::shared_ptr<Scene>>(m, "Scene", "A tree of named nodes with placements, motions and meshes.")
      .def(py::init<>())
      .def("_add_nodes", &add_nodes, py::arg("nodes"))
      .def_property_readonly(
          "nodes", [](const Scene& self) { return self.nodes(); }, "list of Node, parents first")
      .def_property_readonly("meshes", &mesh_entries, "list of SceneMesh by mesh ID")
      .def_property_readonly("num_triangles", &Scene::num_triangles)
      .def_property_readonly("num_nodes", [](const Scene& self) { return self.nodes().size(); })
      .def_property_readonly(
          "breakpoints", [](const Scene& self) { return to_numpy(self.breakpoints()); },
          "Times [N] in s, ascending, where some motion is not smooth.")
      .def("find", &Scene::find, py::arg("name"), "Index of the node with that full name, None where there is none.")
      .def(
          "is_moving", [](const Scene& self, int64_t id) { return self.is_moving(checked_mesh_id(self, id)); },
          py::arg("mesh_id"), "Whether the mesh moves or deforms at some time. Raises IndexError.")
      .def("require_times", &Scene::require_times, py::arg("begin"), py::arg("end"),
           "Raises ValueError naming the node whose motion is not defined on all of [begin, end] (s).")
      .def("world_vertices", &world_vertices_of, py::arg("mesh_id"), py::arg("time") = 0.0,
           "Vertices [V, 3] in m of a mesh at `time` in s, in world coordinates. Raises IndexError, ValueError.")
      .def("coplanar_overlaps", &named_overlaps, py::kw_only(), py::arg("time") = 0.0,
           py::arg("max_distance") = kCoplanarDistance, R"(Where meshes lie on each other, or a mesh lies on itself.

time: s; max_distance: m, up to which two triangles count that are nowhere further apart where one lies over the other
Which of the two a ray meets is decided by rounding. The level of the echo stays that of one surface; its material and the
label are those of the one that is met. Where no ray reaches, as under a box on the ground, it does no harm.
Triangles that merely touch, overlap by less than max_distance, or cross do not count.
Of meshes that are copies of each other at the same place, the first stands for all: each copy is listed with it and with
nothing else.
Returns a list of CoplanarOverlap, by mesh IDs. Takes about a second for a million triangles. Raises ValueError, also for a
time outside a motion.)")
      .def("__repr__", &scene_text);
  m.def("glob_takes", &glob_takes, py::arg("glob"), py::arg("full_name"),
        "Whether a glob takes a mesh name: its full name or an ancestor's; * is any text, / too, and ? one character.");
}

}  // namespace

void bind_scene(py::module_& m) {
  bind_material(m);
  bind_mesh(m);
  bind_readers(m);
  bind_nodes(m);
  bind_overlaps(m);
  bind_scene_tree(m);
}

}  // namespace echopath::bindings
