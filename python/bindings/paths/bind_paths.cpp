#include <pybind11/complex.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "call/argument.h"
#include "call/define.h"
#include "call/run_job.h"
#include "echopath/base/text/streamed.h"
#include "label/named_selections.h"
#include "paths/from_arrays.h"
#include "paths/pass_rows.h"
#include "paths/path_series.h"
#include "values/array.h"
#include "values/in_package.h"
#include "values/shared.h"

namespace echopath::bindings {
namespace {

// A column of the hits, a strided view without a copy.
template <class T>
auto hit_column(T Hit::* field) {
  return [field](const py::object& self) {
    const auto& paths = self.cast<const Paths&>();
    const T* first = paths.num_hits() ? &(paths.hits->front().*field) : nullptr;
    py::array_t<T> array({static_cast<py::ssize_t>(paths.num_hits())}, {static_cast<py::ssize_t>(sizeof(Hit))}, first, self);
    array.attr("setflags")(py::arg("write") = false);
    return array;
  };
}

py::array hits_of(const py::object& self) {
  const auto& paths = self.cast<const Paths&>();
  return numpy_view(paths.num_hits() ? paths.hits->data() : nullptr, {static_cast<py::ssize_t>(paths.num_hits())}, self);
}

py::array curved_cell_of(const py::object& self) {
  const auto& cells = self.cast<const Paths&>().curved_cell;
  return numpy_view(cells.empty() ? nullptr : cells.front().data(), {std::ssize(cells), 7}, self);
}

py::array jones_of(const py::object& self) {
  const auto& matrices = self.cast<const Paths&>().jones;
  const Shape shape{std::ssize(matrices), 2, 2};
  return numpy_view(matrices.empty() ? nullptr : matrices.front().data(), shape, self);
}

// Of a mask: 1 where a path is taken.
using Taken = std::vector<uint8_t>;

// bool [P]
struct Mask {
  using Value = Taken;
  static constexpr auto type_name = py::detail::const_name("ArrayLike");
  static Taken from(py::handle value, const char* argument) {
    const auto keep = checked_array<bool>(value, argument, "[P]");
    return {keep.data(), keep.data() + keep.size()};
  }
};

struct SelectionOrMask {
  using Value = std::variant<Taken, Selection>;
  static constexpr auto type_name = SelectionOrText::type_name + py::detail::const_name(" | ArrayLike");
  static Value from(py::handle value, const char* argument) {
    if (PyUnicode_Check(value.ptr()) || py::isinstance<Selection>(value)) return SelectionOrText::from(value, argument);
    if (!PySequence_Check(value.ptr())) refuse_type(argument, "must be a Selection, its text or a mask, bool [P]", value);
    return Mask::from(value, argument);
  }
};

PathsPtr select_paths(const Paths& paths, Arg<"selection", SelectionOrMask> selection) {
  return run_job("select", py::none(), [&](Job& job) {
    const auto* expression = std::get_if<Selection>(&*selection);
    return std::make_shared<Paths>(
        paths.select(expression ? expression->matches(paths, &job) : std::get<Taken>(*selection), &job));
  });
}

PathsPtr select_with_own_hits(const Paths& paths, Arg<"selection", Mask> mask) {
  return run_job("select", py::none(),
                 [&](Job& job) { return std::make_shared<Paths>(paths.select(*mask, &job).with_own_hits(&job)); });
}

// Paths of each part, in the order of the names.
std::vector<PathsPtr> split(const Paths& paths, const Partition& partition, Job& job) {
  std::vector<PathsPtr> parts;
  for (uint32_t part = 0; part < partition.names.size(); ++part) {
    std::vector<uint8_t> keep(partition.group.size());
    for (size_t path = 0; path < keep.size(); ++path) keep[path] = partition.group[path] == part;
    parts.push_back(std::make_shared<Paths>(paths.select(keep, &job)));
  }
  return parts;
}

py::dict partition_paths(const Paths& paths, Arg<"parts", SelectionsByName> parts) {
  Partition partition;
  const std::vector<PathsPtr> made = run_job("partition", py::none(), [&](Job& job) {
    partition = make_partition(paths, *parts, &job);
    return split(paths, partition, job);
  });
  py::dict out;
  for (size_t part = 0; part < made.size(); ++part) out[py::str(partition.names[part])] = made[part];
  return out;
}

std::string paths_text(const Paths& self) {
  return "Paths(" + counted(self.num_paths(), "path") + ", " + counted(self.num_hits(), "hit") + ")";
}

void bind_series(PathsClass& type) {
  define(type, "amplitudes", &amplitudes_of, py::arg("times"), py::arg("tx") = 0, py::arg("rx") = 0,
         py::arg("replay") = "material",
         R"(Complex amplitudes of the paths over time.

times: [T] s; tx, rx: indices of the transmitter and the receiver; replay: as in `synthesize`
Returns [T, P] in sqrt(W), without the phases of the lengths. Raises TypeError or ValueError naming the argument, also for
times outside a motion, and IndexError for antennas that are not there.)");
  define(type, "lengths", &lengths_of, py::arg("times"), py::arg("transmitter") = 0, py::arg("receiver") = 0,
         py::arg("replay") = "material",
         R"(Lengths of the paths over time.

times: [T] s; transmitter, receiver: indices of antennas, or positions [3] in m in the radar's frame; replay: as in
`synthesize`
Returns [T, P] in m. Raises TypeError or ValueError naming the argument, also for times outside a motion, and IndexError for
antennas that are not there.)");
  define(type, "_placed_echoes", &placed_echoes_of, py::arg("times"), py::arg("radars"), py::arg("replay") = "material",
         R"(Echoes of the paths for antennas of which each moves by itself.

times: [T] s; radars: [T] Radar with as many antennas as that of the paths, where they stand in the world at each time
replay: as in `synthesize`
Returns (delays in s, amplitudes in sqrt(W)), [tx, rx, T, P] each. Raises TypeError or ValueError naming the argument, also for
times outside a motion.)");
  define(type, "_echoes_at_receivers", &echoes_at_receivers, py::arg("time"), py::arg("tx"), py::arg("receivers"),
         R"(Lengths and amplitudes of the paths for several receivers, which take little more time than one.

time: s; tx: index of the transmitter; receivers: indices [R]
Returns (lengths in m, amplitudes in sqrt(W)), [R, P] each, as `lengths` and `amplitudes` give them. Raises TypeError or
ValueError naming the argument, also for times outside a motion, and IndexError for antennas that are not there.)");
  define(type, "_echoes_together", &echoes_together, py::arg("times"), py::arg("tx"), py::arg("rx"), py::arg("begin"),
         py::arg("end"),
         R"(Lengths and amplitudes of some paths at several times, which take little more time than one.

times: [T] s; tx, rx: indices of the transmitter and the receiver; begin, end: of the N paths, by index
Returns (lengths in m, amplitudes in sqrt(W)), [T, N] each, as `lengths` and `amplitudes` give them but for the rounding of
amplitudes. Raises TypeError or ValueError naming the argument, also for times outside a motion, and IndexError for antennas that
are not there.)");
  define(type, "points", &points_of, py::arg("time"),
         "Hits [H, 3] in m in the world at `time` in s. Raises TypeError or ValueError naming the argument.");
}

void bind_parts(PathsClass& type) {
  define(type, "select", &select_paths, py::arg("selection"),
         R"(The paths that a selection takes, over the same hits.

selection: a Selection, its text, or a mask bool [P] that is true where a path is taken
Returns Paths. Raises TypeError or ValueError naming the argument, for faults of the text with a caret under them, and for
names that no mesh has.)");
  define(type, "_select_with_own_hits", &select_with_own_hits, py::arg("selection"),
         "The paths where a mask, bool [P], is true, with only the hits that they use.");
  define(type, "partition", &partition_paths, py::arg("parts"),
         R"(The paths of disjoint parts: the first that takes a path has it, the rest is "other".

parts: {name: selection}
Returns {name: Paths}. Raises TypeError or ValueError naming the argument, also for names that are empty, "other" or twice.)");
}

py::object save_paths(const py::object& self, const py::object& path, Arg<"min_power", Real> min_power) {
  return in_package("frame_file", "save_paths")(self, path, py::arg("min_power") = *min_power);
}

py::object load_paths(const py::object& path) { return in_package("frame_file", "load_paths")(path); }

void bind_exports(PathsClass& type) {
  define(type, "save", &save_paths, py::arg("path"), py::arg("min_power") = 0.0,
         R"(Writes the paths with their scene and radar to an HDF5 file.

path: of the file, written whole or not at all; min_power: in W at the trace time for the first antennas, paths
below it are left out and counted. Returns what was left out. Raises ep.FileError when the file cannot be written.)");
  define_static(type, "load", &load_paths, py::arg("path"),
                "Reads the paths of a frame file at `path`: the same bits that were written. Raises ep.FileError.");
  define(type, "to_dataframe", from_package("presentation.tables", "paths_table"),
         R"(A table with a row for each path, as a pandas.DataFrame.

Columns: bounces (number of hits), meshes (their names in order of travel, "wall > walker/arm"), events (S specular,
D diffuse, E on an edge, a letter a hit), kind ("coherent" or "diffuse"), object, ghost_type and order (as `families` has them for the
objects of the scene), length in m and power in W at the trace time for the first antennas, stratum (what its ray was aimed
at, "" for paths by images), batch (255: of all batches) and is_reversed; units in `attrs["units"]`.
Needs pandas, raises ModuleNotFoundError without it.)");
  define(type, "to_xarray", from_package("presentation.xarray_maps", "paths_dataset"),
         R"(The record as an xarray.Dataset, without a copy of its arrays.

Dimensions path [P] and hit [H]; variables offsets, num_bounces, diffuse, weight, stratum, batch, flags, length (m) and
power (W) at the trace time for the first antennas, [P] each, and mesh_id, triangle_id, u, v [H]; names of the meshes in
attrs["mesh_names"]. Needs xarray, raises ModuleNotFoundError without it.)");
  define(type, "_repr_html_", from_package("presentation.notebook", "paths_html"), "A table for notebooks.");
}

}  // namespace

void bind_paths(py::module_& m) {
  PYBIND11_NUMPY_DTYPE(Hit, mesh_id, triangle_id, u, v);
  PYBIND11_NUMPY_DTYPE(PassRow, mesh_id, triangle_id, u, v, leg);
  PathsClass type(m, "Paths",
                  R"(The record of a trace: what every ray touched. Cannot be changed; its arrays are views.

Path i has the hits offsets[i] to offsets[i] + num_bounces[i], in order of travel from transmitter to receiver. Paths may
share hits; selections share all hits of their trace.)");
  define_no_init(type, "ep.trace, Paths.load and Paths.from_arrays");
  type.def_property_readonly("num_paths", &Paths::num_paths, "P, their number")
      .def_property_readonly("num_hits", &Paths::num_hits, "H, of all paths of the trace")
      .def_property_readonly("hits", &hits_of, "[H] structured: mesh_id, triangle_id, u, v")
      .def_property_readonly("mesh_id", hit_column(&Hit::mesh_id), "[H]")
      .def_property_readonly("triangle_id", hit_column(&Hit::triangle_id), "[H] triangle within the mesh")
      .def_property_readonly("u", hit_column(&Hit::u), "[H] barycentric: p = (1 - u - v) v0 + u v1 + v v2")
      .def_property_readonly("v", hit_column(&Hit::v), "[H] barycentric")
      .def_property_readonly("offsets", view_of(&Paths::offsets), "[P] first hit")
      .def_property_readonly("num_bounces", view_of(&Paths::num_bounces), "[P]")
      .def_property_readonly("diffuse", view_of(&Paths::diffuse), "[P] bit k: hit k is diffuse; 0: coherent")
      .def_property_readonly("weight", view_of(&Paths::weight), "[P] complex, what neither motion nor antennas change")
      .def_property_readonly("stratum", view_of(&Paths::stratum), "[P] index into frame.strata, 65535: image method")
      .def_property_readonly("batch", view_of(&Paths::batch), "[P] batch of rays, 255: all of them (image method)")
      .def_property_readonly(
          "flags", view_of(&Paths::flags),
          "[P] bits: 1, recorded as the reversal of another path; 2, of the second half of the rays; 4, with points on "
          "1 + (flags >> 3 & 3) edges: hit flags >> 8 & 63 is the first, for one of flags >> 16 pieces of it; 32, beside 4, "
          "around an edge to a mirror; 64, diffuse, and counts for others that were left out; 128, an image over unmarked "
          "planes beside an edge, which leaves (flags >> 20) / 1024 of the field of endless ones with the phase (flags >> 8 "
          "& "
          "4095) / 4096 of a turn. Without 4 and 128, flags >> 8 & 63 is the place of its ray among its neighbours in the "
          "lattice: 1 to 63 "
          "over and over, 0 not known")
      .def_property_readonly("jones", &jones_of,
                             "[P, 2, 2] or [0, 2, 2] complex: (horizontal, vertical) at the receiver from the same at the "
                             "transmitter")
      .def_property_readonly("curved_cell", &curved_cell_of,
                             "[P, 7] or [0, 7]: launch cells behind curved specular bounces (record/paths.h); zeros on flat "
                             "chains")
      .def_property_readonly("passes", &passes_of,
                             "[N] structured: mesh_id, triangle_id, u, v and leg of each pass through a sheet, in order of "
                             "travel, path by path; leg k ends at hit k, the last one at the receiver")
      .def_property_readonly("pass_offsets", view_of(&Paths::pass_offsets),
                             "[P + 1] or [0]: path i has the passes pass_offsets[i] to pass_offsets[i + 1]")
      .def_property_readonly("scene", shared_of(&Paths::scene), "snapshot of the scene")
      .def_readonly("radar", &Paths::radar, "snapshot of the radar")
      .def_readonly("frame", &Paths::frame, "times, antenna positions, strata and settings of the trace")
      .def_property_readonly("amplitude", &amplitude_of,
                             "[P] complex, sqrt(W), at the trace time for the first antennas; without the phase of the "
                             "length")
      .def_property_readonly("power", &path_power_of, "[P] W, |amplitude|^2")
      .def_property_readonly("effects", from_package("effects", "of_paths"),
                             "list of Effect: what the trace modelled, what not, and why")
      .def("__len__", &Paths::num_paths)
      .def("__repr__", &paths_text);
  bind_series(type);
  bind_parts(type);
  bind_exports(type);
  bind_from_arrays(type);
}

}  // namespace echopath::bindings
