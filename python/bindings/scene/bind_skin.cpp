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

#include "call/argument.h"
#include "call/define.h"
#include "call/leaving.h"
#include "echopath/base/errors.h"
#include "echopath/base/text/streamed.h"
#include "echopath/scene/readers/skin_parts.h"
#include "scene/deformation_type.h"
#include "values/shared.h"
#include "values/value.h"

namespace echopath::bindings {
namespace {

// A joint as Python makes it: it names its parent.
struct NamedJoint {
  Joint joint;
  std::optional<std::string> parent;
};

NamedJoint named_joint(Arg<"name", Text> name, Arg<"parent", Optional<Text>> parent,
                       Arg<"position", Optional<Vector3>> position, Arg<"transform", Optional<Matrix>> transform,
                       Arg<"motion", Optional<Instance<std::shared_ptr<Motion>>>> motion,
                       Arg<"inverse_bind", Optional<Matrix>> inverse_bind) {
  require(!name->empty(), "name", "must not be empty", "''");
  require(!*transform || !*position, "transform", "must not be given together with position", "both");
  NamedJoint made;
  made.joint.name = *name;
  made.parent = *parent;
  if (*position) made.joint.placement.translation() = **position;
  if (*transform) made.joint.placement = **transform;
  made.joint.motion = motion->value_or(nullptr);
  made.joint.inverse_bind = *inverse_bind;
  return made;
}

std::vector<Joint> numbered(const std::vector<NamedJoint>& named) {
  std::vector<std::string> names;
  std::vector<Joint> joints;
  for (const NamedJoint& each : named) {
    Joint joint = each.joint;
    if (each.parent) {
      const auto found = std::ranges::find(names, *each.parent);
      require(found != names.end(), "joints", "must have the name of an earlier one as parent", "'" + *each.parent + "'");
      joint.parent = static_cast<int>(found - names.begin());
    }
    names.push_back(joint.name);
    joints.push_back(std::move(joint));
  }
  return joints;
}

// Rows [V, K] of weights; without indices column k is joint k.
SkinWeights skin_weights(const py::array_t<double>& given, const std::optional<py::array_t<uint32_t>>& joint_indices,
                         size_t num_joints) {
  SkinWeights out;
  out.per_vertex = given.shape(1);
  out.weight = vector_of(given);
  if (joint_indices) {
    const bool fits = joint_indices->shape(0) == given.shape(0) && joint_indices->shape(1) == given.shape(1);
    if (!fits) refuse_value("joint_indices", "must have the shape of weights, " + shown(given), *joint_indices);
    out.joint = vector_of(*joint_indices);
    return out;
  }
  require(static_cast<size_t>(out.per_vertex) == num_joints, "weights", "must have a column for each joint", out.per_vertex);
  for (py::ssize_t v = 0; v < given.shape(0); ++v) {
    for (uint32_t j = 0; j < num_joints; ++j) out.joint.push_back(j);
  }
  return out;
}

std::shared_ptr<Skin> skin(Arg<"vertices", Points> vertices, Arg<"joints", List<Instance<NamedJoint>>> joints,
                           Arg<"weights", Array<double, "[V, K]">> weights,
                           Arg<"joint_indices", Optional<Array<uint32_t, "[V, K]">>> joint_indices,
                           Arg<"shape", Optional<Instance<std::shared_ptr<Deformation>>>> shape) {
  std::vector<Joint> all = numbered(*joints);
  const SkinWeights rows = skin_weights(*weights, *joint_indices, all.size());
  const WithoutGil released;
  return std::make_shared<Skin>(*vertices, std::move(all), rows, shape->value_or(nullptr));
}

std::vector<NamedJoint> named_joints(const Skin& skin) {
  std::vector<NamedJoint> named;
  for (const Joint& joint : skin.joints()) {
    named.push_back({joint, std::nullopt});
    if (joint.parent >= 0) named.back().parent = skin.joints()[joint.parent].name;
  }
  return named;
}

template <class T>
py::array_t<T> by_vertex(const Skin& skin, std::vector<T> values) {
  const py::ssize_t rows = skin.num_vertices(), columns = std::ssize(values) / rows;
  return numpy_take(std::move(values), {rows, columns});
}

py::array_t<double> matrices(const std::vector<Transform>& transforms) {
  py::array_t<double> out({std::ssize(transforms), py::ssize_t{4}, py::ssize_t{4}});
  for (size_t i = 0; i < transforms.size(); ++i) {
    Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(out.mutable_data() + 16 * i) = transforms[i].matrix();
  }
  return out;
}

py::list parts_of_skin(const Skin& skin, Arg<"mesh", Instance<std::shared_ptr<Mesh>>> mesh) {
  std::vector<NamedMesh> parts;
  {
    const WithoutGil released;
    parts = parts_by_joint(*mesh, skin);
  }
  py::list result;
  for (const NamedMesh& part : parts) result.append(py::make_tuple(part.name, shared(part.mesh)));
  return result;
}

py::array_t<double> joint_transforms(const Skin& self, Arg<"time", Real> time) {
  return matrices(self.joint_transforms(*time));
}

py::object inverse_bind_of(const NamedJoint& self) {
  return self.joint.inverse_bind ? py::object(to_numpy(*self.joint.inverse_bind)) : py::none();
}

void bind_joint(py::module_& m) {
  py::class_<NamedJoint> type(m, "Joint", R"(A joint of a skin. Cannot be changed.

name: unique within its skin; the part of a mesh that it moves is named after it
parent: name of an earlier joint; None: it moves in the frame of the skin
position [3] in m, or transform [4, 4]: at rest, relative to the parent
motion: LinearMotion, KeyframeMotion or CurveMotion about its own origin, as of a node of a scene; None: at rest
inverse_bind: [4, 4] frame of the skin -> frame of the joint where the vertices were bound to it; None: as the joints rest
With transform none and inverse_bind given, a motion is the joint's transform relative to its parent, as in glTF files.
Raises TypeError or ValueError naming the argument.)");
  define_init(type, &named_joint, py::arg("name"), py::arg("parent") = py::none(), py::kw_only(),
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
          "motion", [](const NamedJoint& self) { return shared(self.joint.motion); }, "a motion or None")
      .def_property_readonly("inverse_bind", &inverse_bind_of, "[4, 4], or None where it follows from the joints at rest")
      .def("__repr__", [](const NamedJoint& self) {
        return "Joint('" + self.joint.name + "'" + (self.parent ? ", '" + *self.parent + "')" : ")");
      });
  define_value(type);
  define_replace(type);
}

void bind_skin_itself(py::module_& m) {
  py::class_<Skin, Deformation, std::shared_ptr<Skin>> type(m, "Skin", R"(Deforming mesh: its vertices follow joints.

Linear blend skinning: v(t) = sum over joints of weight * skin_from_joint(t) * inverse_bind * v, exact at every time.
vertices: [V, 3] in m as bound, in the node's frame and in the order of the vertices the mesh was made from
joints: list [J] of Joint, parents first
weights: [V, J], or [V, K] with joint_indices; >= 0, and each row adds up to 1 (less than 1e-4 off is scaled)
joint_indices: [V, K] which joint each weight is of; None: column j of weights is joint j
shape: MorphTargets or VertexSequence that replaces v at each time before the joints move it; None: none
Raises TypeError or ValueError naming the argument.)");
  define_init(type, &skin, py::arg("vertices"), py::arg("joints"), py::arg("weights"), py::arg("joint_indices") = py::none(),
              py::arg("shape") = py::none())
      .def_property_readonly("vertices", array_of(&Skin::vertices), "[V, 3] in m, as bound")
      .def_property_readonly("joints", &named_joints, "list [J] of Joint, each with its inverse_bind")
      .def_property_readonly(
          "weights", [](const Skin& self) { return by_vertex(self, self.weights().weight); },
          "[V, K], K the most joints that a vertex follows; filled up with 0")
      .def_property_readonly(
          "joint_indices", [](const Skin& self) { return by_vertex(self, self.weights().joint); },
          "[V, K] joint of each weight")
      .def_property_readonly("shape", shared_of(&Skin::shape), "the Deformation before the joints move it, or None")
      .def("__repr__", [](const Skin& self) {
        return "Skin(" + std::to_string(self.num_vertices()) + " vertices, " + counted(self.joints().size(), "joint") + ")";
      });
  define(type, "joint_transforms", &joint_transforms, py::arg("time"),
         R"(What moves the vertices that follow one joint alone: skin_from_joint(time) * inverse_bind.

time: s. Returns [J, 4, 4], translations in m. Raises ValueError outside `span`.)");
  define(type, "parts", &parts_of_skin, py::arg("mesh"), R"(The regions of a skinned mesh: triangles by dominant joint.

mesh: a Mesh made from as many vertices [V] as the skin has
Returns a list of (name of joint, Mesh) of those joints that dominate any triangle; all are parts of `mesh`.
Raises ValueError for another number of vertices.)");
  define_value(type);
  define_replace(type);
}

}  // namespace

void bind_skin(py::module_& m) {
  bind_joint(m);
  bind_skin_itself(m);
}

}  // namespace echopath::bindings
