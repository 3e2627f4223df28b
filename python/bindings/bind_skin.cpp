// Skins know meshes, which take them apart, so they are bound behind them.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "array.h"
#include "echopath/base/errors.h"
#include "echopath/scene/readers/skin_parts.h"
#include "keywords.h"
#include "leaving.h"

namespace echopath::bindings {
namespace {

// A joint as Python makes it: it names its parent.
struct NamedJoint {
  Joint joint;
  std::optional<std::string> parent;
};

NamedJoint named_joint(const std::string& name, const py::object& parent, const py::object& position,
                       const py::object& transform, const std::shared_ptr<Motion>& motion, const py::object& inverse_bind,
                       const py::kwargs& unknown) {
  refuse_unknown(unknown, "Joint", {"name", "parent", "position", "transform", "motion", "inverse_bind"});
  NamedJoint made;
  made.joint.name = name;
  if (!parent.is_none()) made.parent = parent.cast<std::string>();
  require(transform.is_none() || position.is_none(), "transform", "must not be given together with position", name);
  if (!position.is_none()) made.joint.placement.translation() = as_vec3(position, "position");
  if (!transform.is_none()) made.joint.placement = as_transform(transform, "transform");
  made.joint.motion = motion;
  if (!inverse_bind.is_none()) made.joint.inverse_bind = as_transform(inverse_bind, "inverse_bind");
  return made;
}

std::vector<Joint> numbered(const std::vector<NamedJoint>& named) {
  std::vector<std::string> names;
  std::vector<Joint> joints;
  for (const NamedJoint& each : named) {
    Joint joint = each.joint;
    if (each.parent) {
      const auto found = std::find(names.begin(), names.end(), *each.parent);
      require(found != names.end(), "parent", "must be the name of an earlier joint", "'" + *each.parent + "'");
      joint.parent = static_cast<int>(found - names.begin());
    }
    names.push_back(joint.name);
    joints.push_back(std::move(joint));
  }
  return joints;
}

// Rows [V, K] of weights; without indices column k is joint k.
SkinWeights skin_weights(const py::object& weights, const py::object& joint_indices, size_t num_joints) {
  SkinWeights out;
  const auto given = checked_array<double>(weights, "weights", "[V, K]");
  out.per_vertex = given.shape(1);
  out.weight.assign(given.data(), given.data() + given.size());
  if (!joint_indices.is_none()) {
    out.joint = as_vector<uint32_t>(joint_indices, "joint_indices",
                                    "[" + std::to_string(given.shape(0)) + ", " + std::to_string(out.per_vertex) + "]");
    return out;
  }
  require(static_cast<size_t>(out.per_vertex) == num_joints, "weights", "must have a column for each joint", out.per_vertex);
  for (py::ssize_t v = 0; v < given.shape(0); ++v) {
    for (uint32_t j = 0; j < num_joints; ++j) out.joint.push_back(j);
  }
  return out;
}

std::shared_ptr<Skin> skin(const py::object& vertices, const std::vector<NamedJoint>& joints, const py::object& weights,
                           const py::object& joint_indices, const py::kwargs& unknown) {
  refuse_unknown(unknown, "Skin", {"vertices", "joints", "weights", "joint_indices"});
  std::vector<Vec3> points = as_points(vertices, "vertices");
  std::vector<Joint> all = numbered(joints);
  const SkinWeights rows = skin_weights(weights, joint_indices, all.size());
  const WithoutGil released;
  return std::make_shared<Skin>(std::move(points), std::move(all), rows);
}

std::vector<NamedJoint> named_joints(const Skin& skin) {
  std::vector<NamedJoint> named;
  for (const Joint& joint : skin.joints()) {
    named.push_back({joint, std::nullopt});
    if (joint.parent >= 0) named.back().parent = skin.joints()[static_cast<size_t>(joint.parent)].name;
  }
  return named;
}

template <class T>
py::array_t<T> by_vertex(const Skin& skin, std::vector<T> values) {
  const py::ssize_t rows = skin.num_vertices(), columns = static_cast<py::ssize_t>(values.size()) / rows;
  return numpy_take(std::move(values), {rows, columns});
}

py::array_t<double> matrices(const std::vector<Transform>& transforms) {
  py::array_t<double> out({static_cast<py::ssize_t>(transforms.size()), py::ssize_t{4}, py::ssize_t{4}});
  for (size_t i = 0; i < transforms.size(); ++i) {
    Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(out.mutable_data() + 16 * i) = transforms[i].matrix();
  }
  return out;
}

py::list parts_of_skin(const Skin& skin, const std::shared_ptr<Mesh>& mesh) {
  std::vector<NamedMesh> parts;
  {
    const WithoutGil released;
    parts = parts_by_joint(mesh, skin);
  }
  py::list result;
  for (const NamedMesh& part : parts) result.append(py::make_tuple(part.name, std::const_pointer_cast<Mesh>(part.mesh)));
  return result;
}

void bind_joint(py::module_& m) {
  py::class_<NamedJoint>(m, "Joint", R"(A joint of a skin. Cannot be changed.

name: unique within its skin; the part of a mesh that it moves is named after it
parent: name of an earlier joint; None: it moves in the frame of the skin
position [3] in m, or transform [4, 4]: at rest, relative to the parent
motion: LinearMotion or KeyframeMotion about its own origin, as of a node of a scene; None: at rest
inverse_bind: [4, 4] frame of the skin -> frame of the joint where the vertices were bound to it; None: as the joints rest
With transform none and inverse_bind given, a motion is the joint's transform relative to its parent, as in glTF files.
Raises ValueError naming the argument.)")
      .def(py::init(&named_joint), py::arg("name"), py::arg("parent") = py::none(), py::kw_only(),
           py::arg("position") = py::none(), py::arg("transform") = py::none(), py::arg("motion") = py::none(),
           py::arg("inverse_bind") = py::none())
      .def_property_readonly(
          "name", [](const NamedJoint& self) { return self.joint.name; }, "of the joint")
      .def_property_readonly(
          "parent", [](const NamedJoint& self) { return self.parent; }, "name of the parent, or None")
      .def_property_readonly(
          "transform", [](const NamedJoint& self) { return to_numpy(self.joint.placement); },
          "[4, 4] at rest, relative to the parent, m")
      .def_property_readonly(
          "motion", [](const NamedJoint& self) { return std::const_pointer_cast<Motion>(self.joint.motion); },
          "a motion or None")
      .def_property_readonly(
          "inverse_bind",
          [](const NamedJoint& self) -> py::object {
            return self.joint.inverse_bind ? py::object(to_numpy(*self.joint.inverse_bind)) : py::none();
          },
          "[4, 4], or None where it follows from the joints at rest")
      .def("__repr__", [](const NamedJoint& self) {
        return "Joint('" + self.joint.name + "'" + (self.parent ? ", '" + *self.parent + "')" : ")");
      });
}

void bind_skin_itself(py::module_& m) {
  py::class_<Skin, Deformation, std::shared_ptr<Skin>>(m, "Skin", R"(Deforming mesh: its vertices follow joints.

Linear blend skinning: v(t) = sum over joints of weight * skin_from_joint(t) * inverse_bind * v, exact at every time.
vertices: [V, 3] in m as bound, in the node's frame and in the order of the vertices the mesh was made from
joints: list [J] of Joint, parents first
weights: [V, J], or [V, K] with joint_indices; >= 0, and each row adds up to 1 (less than 1e-4 off is scaled)
joint_indices: [V, K] which joint each weight is of; None: column j of weights is joint j
Raises ValueError naming the argument.)")
      .def(py::init(&skin), py::arg("vertices"), py::arg("joints"), py::arg("weights"),
           py::arg("joint_indices") = py::none())
      .def_property_readonly(
          "vertices", [](const Skin& self) { return to_numpy(self.vertices()); }, "[V, 3] in m, as bound")
      .def_property_readonly("joints", &named_joints, "list [J] of Joint, each with its inverse_bind")
      .def_property_readonly(
          "weights", [](const Skin& self) { return by_vertex(self, self.weights().weight); },
          "[V, K], K the most joints that a vertex follows; filled up with 0")
      .def_property_readonly(
          "joint_indices", [](const Skin& self) { return by_vertex(self, self.weights().joint); },
          "[V, K] joint of each weight")
      .def(
          "joint_transforms", [](const Skin& self, double time) { return matrices(self.joint_transforms(time)); },
          py::arg("time"), R"(What moves the vertices that follow one joint alone: skin_from_joint(time) * inverse_bind.

time: s. Returns [J, 4, 4], translations in m. Raises ValueError outside `span`.)")
      .def("parts", &parts_of_skin, py::arg("mesh"), R"(The regions of a skinned mesh: triangles by dominant joint.

mesh: a Mesh made from as many vertices [V] as the skin has
Returns a list of (name of joint, Mesh) of those joints that dominate any triangle; all are parts of `mesh`.
Raises ValueError for another number of vertices.)")
      .def("__repr__", [](const Skin& self) {
        return "Skin(" + std::to_string(self.num_vertices()) + " vertices, " + std::to_string(self.joints().size()) +
               " joints)";
      });
}

}  // namespace

void bind_skin(py::module_& m) {
  bind_joint(m);
  bind_skin_itself(m);
}

}  // namespace echopath::bindings
