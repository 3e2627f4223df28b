#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "call/leaving.h"
#include "echopath/posed/enclosures.h"
#include "echopath/posed/object_sizes.h"
#include "echopath/posed/posed_antenna.h"
#include "echopath/scene/coherent_meshes.h"
#include "echopath/scene/large_planes.h"
#include "echopath/scene/mesh/surface_widths.h"
#include "echopath/scene/mesh_traits.h"
#include "values/array.h"
#include "values/shared.h"

namespace echopath::bindings {
namespace {

// Returns (node [N], sides [N, 2], closed [N], [(node, of receivers)]).
py::tuple look_at_bodies(const Scene& scene, const Radar& radar, double time) {
  const PosedScene pose(scene, time);
  const std::vector<Body> bodies = bodies_of(scene, pose);
  const std::vector<ObjectSize> sizes = object_sizes(scene, bodies);
  const auto count = std::ssize(sizes);
  py::array_t<int32_t> node(count);
  py::array_t<double> sides({count, py::ssize_t{2}});
  py::array_t<bool> closed(count);
  for (py::ssize_t i = 0; i < count; ++i) {
    const ObjectSize& size = sizes[i];
    node.mutable_at(i) = size.node;
    sides.mutable_at(i, 0) = size.shortest;
    sides.mutable_at(i, 1) = size.longest;
    closed.mutable_at(i) = size.is_closed;
  }
  std::vector<std::pair<int, bool>> around;
  for (const Enclosure& enclosure : enclosures(scene, pose, bodies, radar))
    around.emplace_back(enclosure.node, enclosure.of_receivers);
  return py::make_tuple(node, sides, closed, around);
}

// Returns (materials, index of each mesh's [M], smooth [M], moving [M], deforming [M]).
py::tuple traits_of_meshes(const Scene& scene) {
  const MeshTraits traits = mesh_traits(scene);
  py::list materials;
  for (const MaterialPtr& material : traits.materials) materials.append(shared(material));
  const auto flags = [](const std::vector<uint8_t>& values) { return py::object(to_numpy(values).attr("astype")("bool")); };
  return py::make_tuple(materials, to_numpy(traits.material), flags(traits.smooth), flags(traits.moving),
                        flags(traits.deforming));
}

std::vector<std::pair<uint32_t, std::vector<uint32_t>>> large_planes(const Scene& scene, const Radar& radar,
                                                                     double wavelength, double time, double least_coherent,
                                                                     double least_area, double least_extent,
                                                                     double least_area_of_short, double vehicle_length,
                                                                     double vehicle_width, int most_small_planes) {
  LargePlaneRule rule{{},           wavelength,          time,           least_coherent, least_area,
                      least_extent, least_area_of_short, vehicle_length, vehicle_width,  most_small_planes};
  for (const auto& antennas : {radar.transmitters, radar.receivers}) {
    for (const PosedAntenna& antenna : posed_antennas(antennas, radar.world_from_radar(time), Vec3::Zero()))
      rule.antennas.push_back(antenna.position);
  }
  // Others may change the scene meanwhile.
  const Scene seen = scene;  // NOLINT(performance-unnecessary-copy-initialization)
  const WithoutGil released;
  std::vector<std::pair<uint32_t, std::vector<uint32_t>>> found;
  for (MeshOfLargePlanes& mesh : meshes_of_large_planes(seen, rule)) found.emplace_back(mesh.mesh_id, std::move(mesh.small));
  return found;
}

std::vector<uint32_t> meshes_cut_from_mirrors(const Scene& scene) {
  std::vector<uint32_t> found;
  for (uint32_t id = 0; id < scene.meshes().size(); ++id)
    if (is_cut_from_mirror(scene, id)) found.push_back(id);
  return found;
}

std::vector<double> widths_of_meshes(const Scene& scene, const std::vector<uint32_t>& mesh_ids, double time) {
  const PosedScene pose(scene, time);
  SurfaceWidths widths;
  std::vector<double> found;
  for (const uint32_t id : mesh_ids) found.push_back(widths.width_of(*scene.node_of(id).mesh, pose.world_vertices(id)));
  return found;
}

std::array<double, 3> centroid_of_meshes(const Scene& scene, const std::vector<uint32_t>& mesh_ids, double time) {
  const Vec3 centroid = surface_centroid(scene, mesh_ids, time);
  return {centroid.x(), centroid.y(), centroid.z()};
}

std::vector<std::string> names_of_meshes(const Scene& scene, const std::vector<uint32_t>& mesh_ids) {
  std::vector<std::string> names;
  for (const uint32_t id : mesh_ids) names.push_back(scene.nodes()[scene.meshes().at(id).node].name);
  return names;
}

}  // namespace

// Binds what reports on scenes ask for, no part of the public interface.
void bind_scene_reports(py::module_& m) {
  m.def("coherent_meshes", &coherent_meshes, py::arg("scene"), py::arg("wavelength"), py::arg("least_share"),
        py::arg("without_planes") = false,
        "IDs of the meshes that reflect this share of the power in phase at a wavelength in m, mirrors left out.");
  m.def("meshes_of_large_planes", &large_planes, py::arg("scene"), py::arg("radar"), py::arg("wavelength"), py::arg("time"),
        py::arg("least_coherent"), py::arg("least_area"), py::arg("least_extent"), py::arg("least_area_of_short"),
        py::arg("vehicle_length"), py::arg("vehicle_width"), py::arg("most_small_planes"),
        "Meshes that planes larger than their Fresnel zone make up at a wavelength in m and a time in s: [(ID, triangles of "
        "their other planes, none where these are few)].");
  m.def("meshes_cut_from_mirrors", &meshes_cut_from_mirrors, py::arg("scene"),
        "IDs of the meshes that are parts of one mesh with the flagged mirror above them.");
  m.def("look_at_bodies", &look_at_bodies, py::arg("scene"), py::arg("radar"), py::arg("time"),
        "Of the children of the root: (node [N]; sides [N, 2] in m, shortest and longest; closed [N]; those in which the "
        "first transmitter stands, or the first receiver, [(node, whether it is the receiver)]).");
  m.def(
      "mesh_traits", &traits_of_meshes, py::arg("scene"),
      "Of all meshes: (materials, each once; index of each mesh's [M]; whether it is smooth [M], moves [M], deforms [M]).");
  m.def("mesh_widths", &widths_of_meshes, py::arg("scene"), py::arg("mesh_ids"), py::arg("time"),
        "Middle extents in m along the principal axes of meshes by their IDs, at a time in s: the diameter of a rod. Parts "
        "of a "
        "surface have that of the whole.");
  m.def("surface_centroid", &centroid_of_meshes, py::arg("scene"), py::arg("mesh_ids"), py::arg("time"),
        "Centroid [3] in m of the surface of meshes by their IDs together, in the world at a time in s.");
  m.def("mesh_names", &names_of_meshes, py::arg("scene"), py::arg("mesh_ids"), "Full names by mesh IDs.");
}

}  // namespace echopath::bindings
