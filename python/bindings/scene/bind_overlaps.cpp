#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <string>
#include <vector>

#include "call/argument.h"
#include "call/define.h"
#include "call/run_job.h"
#include "echopath/base/text/streamed.h"
#include "echopath/scene/overlap/coplanar.h"
#include "echopath/scene/scene.h"
#include "values/travel.h"

namespace echopath::bindings {
namespace {

// What scene.coplanar_overlaps lists.
struct NamedOverlap {
  CoplanarOverlap overlap;
  std::string first, second;
};

std::vector<NamedOverlap> named_overlaps(const Scene& scene, Arg<"time", Real> time,
                                         Arg<"max_distance", Real> max_distance) {
  // Others may change the scene while the work runs.
  const Scene kept = scene;  // NOLINT(performance-unnecessary-copy-initialization)
  const auto found = run_job("coplanar overlaps", py::none(),
                             [&](Job& job) { return coplanar_overlaps(kept, *time, *max_distance, &job); });
  std::vector<NamedOverlap> named;
  for (const CoplanarOverlap& one : found) {
    named.push_back({one, kept.node_of(one.first_mesh_id).name, kept.node_of(one.second_mesh_id).name});
  }
  return named;
}

std::string overlap_text(const NamedOverlap& self) {
  return streamed("CoplanarOverlap('", self.first, "', '", self.second, "', ",
                  counted(self.overlap.num_triangles, "triangle"), ", ", self.overlap.area, " m^2)");
}

}  // namespace

void bind_overlaps(py::module_& m) {
  py::class_<NamedOverlap> type(m, "CoplanarOverlap", "Where two meshes, or a mesh and itself, lie on each other.");
  define_no_init(type, "scene.coplanar_overlaps()");
  type.def_property_readonly(
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
  const auto of_overlap = [](const char* name, auto member) {
    return field(name, [member](auto& self) -> auto& { return self.overlap.*member; });
  };
  def_travel(type, field("first", &NamedOverlap::first), field("second", &NamedOverlap::second),
             of_overlap("first_mesh_id", &CoplanarOverlap::first_mesh_id),
             of_overlap("second_mesh_id", &CoplanarOverlap::second_mesh_id),
             of_overlap("num_triangles", &CoplanarOverlap::num_triangles), of_overlap("area", &CoplanarOverlap::area),
             of_overlap("distance", &CoplanarOverlap::distance));
  auto tree = py::reinterpret_borrow<py::class_<Scene, std::shared_ptr<Scene>>>(m.attr("Scene"));
  define(tree, "coplanar_overlaps", &named_overlaps, py::kw_only(), py::arg("time") = 0.0,
         py::arg("max_distance") = kCoplanarDistance, R"(Where meshes lie on each other, or a mesh lies on itself.

time: s; max_distance: m, up to which two triangles count that are nowhere further apart where one lies over the other
Which of the two a ray meets is decided by rounding. The level of the echo stays that of one surface; its material and the
label are those of the one that is met. Where no ray reaches, as under a box on the ground, it does no harm.
Triangles that merely touch, overlap by less than max_distance, or cross do not count.
Of meshes that are copies of each other at the same place, the first stands for all: each copy is listed with it and with
nothing else.
Returns a list of CoplanarOverlap, by mesh IDs. Takes about a second for a million triangles. Raises ValueError, also for a
time outside a motion.)");
}

}  // namespace echopath::bindings
