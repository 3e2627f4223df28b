// Polygons of other libraries' meshes, cut into triangles as those of files are.
#include <pybind11/pybind11.h>

#include <numeric>
#include <vector>

#include "echopath/base/errors.h"
#include "echopath/scene/readers/soup.h"
#include "values/array.h"

namespace echopath::bindings {
namespace {

py::tuple triangles_of_polygons(const py::object& vertices, const py::object& corners, const py::object& counts) {
  Soup soup;
  soup.vertices = as_points(vertices, "vertices");
  const std::vector<uint32_t> all = as_vector<uint32_t>(corners, "corners");
  for (const uint32_t corner : all)
    require(corner < soup.vertices.size(), "corners", "must be below the number of vertices", corner);
  size_t begin = 0;
  for (const uint32_t count : as_vector<uint32_t>(counts, "counts")) {
    require(count >= 3, "counts", "must be at least 3 corners", count);
    require(count <= all.size() - begin, "counts", "must not go beyond the corners", count);
    std::vector<uint32_t> places(count);
    std::iota(places.begin(), places.end(), static_cast<uint32_t>(begin));
    const auto first = all.begin() + static_cast<ptrdiff_t>(begin);
    soup.add_polygon({first, first + static_cast<ptrdiff_t>(count)}, 0, places);
    begin += count;
  }
  require(begin == all.size(), "counts", "must add up to the number of corners", begin);
  return py::make_tuple(to_numpy(soup.triangles), to_numpy(soup.face), to_numpy(soup.normal));
}

}  // namespace

void bind_polygons(py::module_& m) {
  m.def("triangles_of_polygons", &triangles_of_polygons, py::arg("vertices"), py::arg("corners"), py::arg("counts"),
        R"(Polygons cut into triangles as load_mesh cuts those of files.

vertices: [V, 3] in m; corners: [N] indices of vertices, polygon by polygon; counts: [F] corners of each, three or more
Returns the triangles [T, 3], the polygon of each [T] and the places [T, 3] of their corners in `corners`. Raises ValueError.)");
}

}  // namespace echopath::bindings
