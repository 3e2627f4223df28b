#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "call/argument.h"
#include "call/define.h"
#include "call/shown.h"
#include "echopath/base/errors.h"
#include "echopath/base/text/nearest_names.h"
#include "echopath/base/text/streamed.h"
#include "echopath/scene/scene.h"
#include "scene/deformation_type.h"
#include "values/array.h"
#include "values/shared.h"
#include "values/travel.h"
#include "values/value.h"

namespace echopath::bindings {
namespace {

template <class T>
using OrNone = Optional<Instance<std::shared_ptr<T>>>;

TimeSpan span_of(const std::vector<double>& ends) {
  const bool is_span = ends.size() == 2 && ends[0] < ends[1];
  require(is_span, "lifetime", "must be (begin, end) in s, ascending, or None", py::str(py::cast(ends)).cast<std::string>());
  return {std::max(ends[0], TimeSpan{}.begin), std::min(ends[1], TimeSpan{}.end)};
}

Node node(Arg<"name", Text> name, Arg<"parent", Whole<-1, std::numeric_limits<int>::max()>> parent,
          Arg<"placement", Optional<Matrix>> placement, Arg<"motion", OrNone<Motion>> motion, Arg<"mesh", OrNone<Mesh>> mesh,
          Arg<"deformation", OrNone<Deformation>> deformation, Arg<"material", OrNone<Material>> material,
          Arg<"material_name", Text> material_name, Arg<"smooth", Flag> smooth, Arg<"visible", Flag> visible,
          Arg<"lifetime", Optional<List<Number>>> lifetime) {
  Node made;
  made.name = *name;
  made.parent = *parent;
  if (*placement) made.placement = **placement;
  made.motion = motion->value_or(nullptr);
  made.mesh = mesh->value_or(nullptr);
  made.deformation = deformation->value_or(nullptr);
  made.material = material->value_or(nullptr);
  made.material_name = *material_name;
  made.smooth = *smooth;
  made.visible = *visible;
  if (*lifetime) made.lifetime = span_of(**lifetime);
  return made;
}

// (begin, end) in s, infinite where there is none.
using Ends = std::pair<double, double>;

Ends ends_of(const TimeSpan& span) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const TimeSpan always;
  return {span.begin > always.begin ? span.begin : -kInfinity, span.end < always.end ? span.end : kInfinity};
}

// Returns when a node is there; None: always.
std::optional<Ends> lifetime_of(const Node& node) {
  const Ends ends = ends_of(node.lifetime);
  return ends == ends_of(TimeSpan{}) ? std::nullopt : std::optional(ends);
}

// What scene.meshes lists.
struct MeshEntry {
  uint32_t id = 0;
  int node_index = 0;
  Node node;
};

void require_mesh(const MeshEntry& entry) {
  require(entry.node.mesh != nullptr && entry.node.material != nullptr, "node", "must have a mesh and a material",
          entry.node.name);
}

uint32_t checked_mesh_id(const Scene& scene, int mesh_id) {
  const auto count = std::ssize(scene.meshes());
  if (mesh_id >= 0 && mesh_id < count) return static_cast<uint32_t>(mesh_id);
  throw std::out_of_range("mesh_id: must lie in 0 to " + std::to_string(count - 1) + ", got " + std::to_string(mesh_id));
}

// All nodes or none.
void add_nodes(Scene& scene, const std::vector<Node>& nodes) {
  const size_t num_before = scene.nodes().size();
  try {
    for (const Node& node : nodes) scene.add(node);
  } catch (...) {
    while (scene.nodes().size() > num_before) scene.remove(static_cast<int>(scene.nodes().size()) - 1);
    throw;
  }
}

// The nodes of a scene in their order make the same scene again.
Scene scene_of(const std::vector<Node>& nodes) {
  Scene scene;
  for (Node node : nodes) {
    node.name = node.name.substr(node.name.rfind('/') + 1);
    scene.add(std::move(node));
  }
  return scene;
}

Scene scene_of_state(const py::object& state) {
  std::vector<Node> nodes;
  const bool is_list =
      py::isinstance<py::tuple>(state) && py::len(state) == 1 && py::isinstance<py::list>(py::object(state[py::int_(0)]));
  if (!is_list) refuse_type("state", "must be that of a Scene", state);
  for (const py::handle node : py::list(state[py::int_(0)])) {
    if (!py::isinstance<Node>(node)) refuse_type("state", "must hold Nodes", node);
    nodes.push_back(node.cast<Node>());
  }
  return scene_of(nodes);
}

int index_of_name(const Scene& scene, const py::object& name) {
  constexpr const char* kRule = "must be the full name of a node";
  if (!py::isinstance<py::str>(name)) refuse_type("name", kRule, name);
  const std::string text = escaped(name);
  if (const std::optional<int> index = scene.find(text)) return *index;
  std::vector<std::string> names;
  for (const Node& node : scene.nodes()) names.push_back(node.name);
  std::string nearest;
  for (const std::string& one : nearest_names(text, names)) nearest += (nearest.empty() ? "" : ", ") + one;
  throw py::key_error("name: " + std::string(kRule) +
                      " (nearest: " + (names.empty() ? "none, the scene is empty" : nearest) + "), got " + shown(name));
}

bool has_name(const Scene& scene, const py::object& name) {
  return py::isinstance<py::str>(name) && scene.find(escaped(name)).has_value();
}

py::list names_of(const Scene& scene) {
  py::list names;
  for (const Node& node : scene.nodes()) names.append(node.name);
  return names;
}

std::vector<MeshEntry> mesh_entries(const Scene& scene) {
  std::vector<MeshEntry> entries;
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) {
    entries.push_back({id, scene.meshes()[id].node, scene.node_of(id)});
  }
  return entries;
}

using MeshId = Arg<"mesh_id", Whole<std::numeric_limits<int>::min(), std::numeric_limits<int>::max()>>;

bool is_mesh_moving(const Scene& scene, MeshId mesh_id) { return scene.is_moving(checked_mesh_id(scene, *mesh_id)); }

py::array_t<double> world_vertices_of(const Scene& scene, MeshId mesh_id, Arg<"time", Real> time) {
  return to_numpy(world_vertices(scene, checked_mesh_id(scene, *mesh_id), *time));
}

std::optional<int> find_node(const Scene& scene, Arg<"name", Text> name) { return scene.find(*name); }

void require_scene_times(const Scene& scene, Arg<"begin", Real> begin, Arg<"end", Real> end) {
  scene.require_times(*begin, *end);
}

std::string scene_text(const Scene& self) {
  return "Scene(" + counted(self.nodes().size(), "node") + ", " + counted(self.meshes().size(), "mesh", "meshes") + ", " +
         counted(self.num_triangles(), "triangle") + ")";
}

void bind_nodes(py::module_& m) {
  py::class_<Node> type(m, "Node", "A node of a scene; cannot be changed.");
  define_init(type, &node, py::kw_only(), py::arg("name"), py::arg("parent") = -1, py::arg("placement") = py::none(),
              py::arg("motion") = py::none(), py::arg("mesh") = py::none(), py::arg("deformation") = py::none(),
              py::arg("material") = py::none(), py::arg("material_name") = "", py::arg("smooth") = false,
              py::arg("visible") = true, py::arg("lifetime") = py::none());
  define_value(type);
  define_replace(type);
  type.def_readonly("name", &Node::name, "full name, \"street/pedestrian/head\"")
      .def_readonly("parent", &Node::parent, "index of the parent, -1 for a child of the root")
      .def_property_readonly("placement", array_of(&Node::placement), "[4, 4] at rest, relative to the parent, m")
      .def_property_readonly("motion", shared_of(&Node::motion), "a motion or None")
      .def_property_readonly("mesh", shared_of(&Node::mesh), "a Mesh or None")
      .def_property_readonly("deformation", shared_of(&Node::deformation), "a VertexSequence, a Skin or None")
      .def_property_readonly("material", shared_of(&Node::material), "a Material or None")
      .def_readonly("material_name", &Node::material_name, "as given, \"\" for a material without a name")
      .def_readonly("smooth", &Node::smooth, "whether the mesh stands for a curved surface")
      .def_readonly("visible", &Node::visible, "False: neither it nor what is below it takes part in anything")
      .def_property_readonly("lifetime", &lifetime_of,
                             "(begin, end) in s: it is part of the frames that this covers wholly; None: of all")
      .def("__repr__", [](const Node& self) { return "Node('" + self.name + "'" + (self.mesh ? ", mesh)" : ")"); });

  py::class_<MeshEntry> entry(m, "SceneMesh", "A mesh of a scene with its mesh ID.");
  define_no_init(entry, "scene.meshes");
  def_travel_checked(entry, &require_mesh, attribute("id", &MeshEntry::id, "mesh ID"),
                     field("node_index", &MeshEntry::node_index), field("node", &MeshEntry::node));
  entry.def("__hash__", [](const MeshEntry& self) { return py::hash(py::make_tuple(self.id, self.node.name)); })
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
        const std::string count = counted(self.node.mesh->triangles().size(), "triangle");
        return "SceneMesh(" + std::to_string(self.id) + ", '" + self.node.name + "', " + count + ")";
      });
}

void bind_tree(py::module_& m) {
  py::class_<Scene, std::shared_ptr<Scene>> tree(m, "Scene", "A tree of named nodes with placements, motions and meshes.");
  tree.def(py::init<>())
      .def(py::init<const Scene&>(), py::arg("scene"), "A copy.")
      .def("_add_nodes", &add_nodes, py::arg("nodes"))
      .def("_index_of", &index_of_name, py::arg("name"), "Raises KeyError naming the nearest names.")
      .def(
          "_node", [](const Scene& self, int index) { return self.nodes().at(static_cast<size_t>(index)); },
          py::arg("index"))
      .def("_change", &Scene::change, py::arg("index"), py::arg("node"))
      .def("_remove", &Scene::remove, py::arg("index"))
      .def("_takes_part", &Scene::takes_part, py::arg("index"))
      .def("_hide_absent", &Scene::hide_absent, py::arg("begin"), py::arg("end"))
      .def(
          "_lifetime", [](const Scene& self, int index) { return ends_of(self.lifetime(index)); }, py::arg("index"))
      .def_property_readonly("_has_lifetimes", &Scene::has_lifetimes)
      .def("__len__", [](const Scene& self) { return self.nodes().size(); })
      .def(
          "__iter__", [](const Scene& self) { return names_of(self).attr("__iter__")(); }, "Full names, parents first.")
      .def("__contains__", &has_name, py::arg("name"), "Whether there is a node with that full name.")
      .def(
          "__getitem__", [](const Scene& self, const py::object& name) { return self.nodes()[index_of_name(self, name)]; },
          py::arg("name"), "The Node with that full name, \"street/car\". Raises KeyError naming the nearest names.")
      .def("__copy__", [](const py::object& self) { return py::type::of(self)(self); })
      .def(
          "__deepcopy__", [](const py::object& self, const py::dict&) { return py::type::of(self)(self); }, py::arg("memo"),
          "Shares meshes, motions and materials, which cannot change.")
      .def(py::pickle([](const Scene& self) { return py::make_tuple(self.nodes()); }, &scene_of_state))
      .def_property_readonly(
          "nodes", [](const Scene& self) { return self.nodes(); }, "list of Node, parents first")
      .def_property_readonly("meshes", &mesh_entries, "list of SceneMesh that take part, by mesh ID")
      .def_property_readonly("num_triangles", &Scene::num_triangles)
      .def_property_readonly(
          "breakpoints", [](const Scene& self) { return to_numpy(self.breakpoints()); },
          "Times [N] in s, ascending, where some motion is not smooth.")
      .def("__repr__", &scene_text);
  define(tree, "find", &find_node, py::arg("name"), "Index of the node with that full name, None where there is none.");
  define(tree, "is_moving", &is_mesh_moving, py::arg("mesh_id"),
         "Whether the mesh moves or deforms at some time. Raises IndexError.");
  define(tree, "require_times", &require_scene_times, py::arg("begin"), py::arg("end"),
         "Raises ValueError naming the node whose motion is not defined on all of [begin, end] (s) within its lifetime.");
  define(tree, "world_vertices", &world_vertices_of, py::arg("mesh_id"), py::arg("time") = 0.0,
         "Vertices [V, 3] in m of a mesh at `time` in s, in world coordinates. Raises IndexError, ValueError.");
  m.def("glob_takes", &glob_takes, py::arg("glob"), py::arg("full_name"),
        "Whether a glob takes a mesh name: its full name or an ancestor's; * is any text, / too, and ? one character.");
}

}  // namespace

void bind_scene_tree(py::module_& m) {
  bind_nodes(m);
  bind_tree(m);
}

}  // namespace echopath::bindings
