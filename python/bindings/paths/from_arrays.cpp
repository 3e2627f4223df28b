#include "paths/from_arrays.h"

#include <pybind11/complex.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <complex>
#include <string>
#include <vector>

#include "call/argument.h"
#include "call/define.h"
#include "call/run_job.h"
#include "paths/pass_rows.h"
#include "values/array.h"
#include "values/travel.h"

namespace echopath::bindings {
namespace {

// [H] structured, as Paths.hits has them.
struct HitRows {
  using Value = StructuredArray<Hit>;
  static constexpr auto type_name = py::detail::const_name("ArrayLike");
  static Value from(py::handle value, const char* argument) {
    return structured_array<Hit>(value, argument,
                                 "must be an array [H] of (mesh_id, triangle_id, u, v) as Paths.hits has it");
  }
};

// Rows of `size` numbers.
template <class Row, class T, int kFlags>
std::vector<Row> rows_of(const py::array_t<T, kFlags>& values, size_t size) {
  std::vector<Row> rows(static_cast<size_t>(values.size()) / size);
  std::copy(values.data(), values.data() + values.size(), rows.empty() ? nullptr : rows.front().data());
  return rows;
}

using ComplexFloat = std::complex<float>;

PathsPtr paths_from_arrays(Arg<"hits", HitRows> hits, Arg<"offsets", Array<int64_t, "[P]">> offsets,
                           Arg<"num_bounces", Array<uint8_t, "[P]">> num_bounces,
                           Arg<"diffuse", Array<uint64_t, "[P]">> diffuse, Arg<"weight", Array<ComplexFloat, "[P]">> weight,
                           Arg<"stratum", Array<uint16_t, "[P]">> stratum, Arg<"batch", Array<uint8_t, "[P]">> batch,
                           Arg<"flags", Array<uint32_t, "[P]">> flags,
                           Arg<"curved_cell", Optional<Array<float, "[P, 7]">>> curved_cell,
                           Arg<"jones", Optional<Array<ComplexFloat, "[P, 2, 2]">>> jones,
                           Arg<"passes", Optional<PassRows>> passes,
                           Arg<"pass_offsets", Optional<Array<int64_t, "[P + 1]">>> pass_offsets,
                           Arg<"scene", Instance<std::shared_ptr<Scene>>> scene, Arg<"radar", Instance<Radar>> radar,
                           Arg<"frame", Instance<TraceFrame>> frame) {
  auto paths = std::make_shared<Paths>();
  paths->hits = std::make_shared<const std::vector<Hit>>(vector_of(*hits));
  paths->offsets = vector_of(*offsets);
  paths->num_bounces = vector_of(*num_bounces);
  paths->diffuse = vector_of(*diffuse);
  paths->weight = vector_of(*weight);
  paths->stratum = vector_of(*stratum);
  paths->batch = vector_of(*batch);
  paths->flags = vector_of(*flags);
  if (*curved_cell) paths->curved_cell = rows_of<decltype(paths->curved_cell)::value_type>(**curved_cell, 7);
  if (*jones) paths->jones = rows_of<decltype(paths->jones)::value_type>(**jones, 4);
  if (*passes) paths->passes = **passes;
  if (*pass_offsets) paths->pass_offsets = vector_of(**pass_offsets);
  paths->scene = std::make_shared<const Scene>(**scene);
  paths->radar = *radar;
  paths->frame = *frame;
  run_job("check", py::none(), [&](Job&) { paths->validate(); });
  return paths;
}

// What from_arrays takes, by name: also the state of a pickle.
const std::vector<std::string> kPathsState = {"hits",    "offsets",      "num_bounces", "diffuse",     "weight",
                                              "stratum", "batch",        "flags",       "curved_cell", "jones",
                                              "passes",  "pass_offsets", "scene",       "radar",       "frame"};

py::dict paths_state(const py::object& self) {
  py::dict state;
  for (const std::string& name : kPathsState) state[name.c_str()] = self.attr(name.c_str());
  for (const char* name : {"curved_cell", "jones", "passes", "pass_offsets"}) {
    if (py::len(state[name]) == 0) state[name] = py::none();
  }
  return state;
}

PathsPtr paths_of_state(const py::dict& state) {
  require_fields(state, kPathsState);
  return py::type::of<Paths>().attr("from_arrays")(**state).cast<PathsPtr>();
}

}  // namespace

void bind_from_arrays(PathsClass& type) {
  type.def(py::pickle(&paths_state, &paths_of_state));
  define_static(type, "from_arrays", &paths_from_arrays, py::kw_only(), py::arg("hits"), py::arg("offsets"),
                py::arg("num_bounces"), py::arg("diffuse"), py::arg("weight"), py::arg("stratum"), py::arg("batch"),
                py::arg("flags"), py::arg("curved_cell") = py::none(), py::arg("jones") = py::none(),
                py::arg("passes") = py::none(), py::arg("pass_offsets") = py::none(), py::arg("scene"), py::arg("radar"),
                py::arg("frame"),
                R"(Paths of arrays as the properties give them.

hits: [H] structured; offsets, num_bounces, diffuse, weight, stratum, batch, flags: [P]; curved_cell: [P, 7] or None; jones:
[P, 2, 2] complex or None; passes: [N] structured and pass_offsets: [P + 1], or None
scene, radar, frame: what they belong to
Raises ValueError where an index leads nowhere.)");
}

}  // namespace echopath::bindings
