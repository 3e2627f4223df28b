#include <pybind11/complex.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <optional>
#include <sstream>
#include <string>

#include "array.h"
#include "choice.h"
#include "echopath/base/parallel.h"
#include "echopath/label/partition.h"
#include "echopath/replay/received_power.h"
#include "echopath/replay/replay.h"
#include "echopath/trace/trace.h"
#include "error_target.h"
#include "keywords.h"
#include "run_job.h"

namespace echopath::bindings {
namespace {

using PathsPtr = std::shared_ptr<Paths>;

// --- TraceFrame and what it holds ---

void bind_frame(py::module_& m) {
  py::class_<Stratum>(m, "Stratum", "One launch stratum: uniform directions in a cone.")
      .def(py::init([](const py::object& axis, double versine, int64_t num_rays, double ray_density,
                       std::string name) {
             Stratum made;
             made.axis = as_vec3(axis, "axis");
             made.versine = versine;
             made.num_rays = num_rays;
             made.ray_density = ray_density;
             made.name = std::move(name);
             return made;
           }),
           py::kw_only(), py::arg("axis"), py::arg("versine"), py::arg("num_rays"), py::arg("ray_density"),
           py::arg("name"))
      .def_property_readonly("axis", [](const Stratum& self) { return to_numpy(self.axis); }, "[3] unit, world axes")
      .def_readonly("versine", &Stratum::versine, "1 - cos of the half angle; 2 is the whole sphere")
      .def_readonly("num_rays", &Stratum::num_rays, "launched in it")
      .def_readonly("name", &Stratum::name, "what it aims at")
      .def_readonly("ray_density", &Stratum::ray_density, "rays per sr")
      .def("__repr__", [](const Stratum& self) {
        return "Stratum('" + self.name + "', " + std::to_string(self.num_rays) + " rays)";
      });

  py::class_<TraceStatistics>(m, "TraceStatistics", "What a trace did.")
      .def(py::init([](int64_t rays, int64_t queries, int64_t hits, int64_t recorded, int64_t near, int64_t grazing, int64_t small,
                       int64_t false_hits) {
             return TraceStatistics{rays, queries, hits, recorded, near, grazing, small, false_hits};
           }),
           py::kw_only(), py::arg("num_rays") = 0, py::arg("num_queries") = 0, py::arg("num_hits") = 0, py::arg("num_paths") = 0,
           py::arg("num_near_antenna") = 0, py::arg("num_grazing") = 0, py::arg("num_small_mirrors") = 0,
           py::arg("num_false_hits") = 0)
      .def_readonly("num_rays", &TraceStatistics::num_rays, "launched")
      .def_readonly("num_queries", &TraceStatistics::num_queries, "closest-hit and shadow queries")
      .def_readonly("num_hits", &TraceStatistics::num_hits, "surface points found")
      .def_readonly("num_paths", &TraceStatistics::num_paths, "recorded; selections have fewer")
      .def_readonly("num_near_antenna", &TraceStatistics::num_near_antenna, "dropped: within 1 mm of an antenna")
      .def_readonly("num_grazing", &TraceStatistics::num_grazing, "dropped: cosine of incidence below 1e-3")
      .def_readonly("num_small_mirrors", &TraceStatistics::num_small_mirrors,
                    "rays ended behind an unflagged mirror smaller than its Fresnel zone")
      .def_readonly("num_false_hits", &TraceStatistics::num_false_hits, "not confirmed in double precision");

  py::class_<TraceFrame>(m, "TraceFrame", "What amplitudes and lengths of paths are relative to.")
      .def(py::init([](double start_time, double trace_time, const py::object& transmitter, const py::object& receiver,
                       std::vector<Stratum> strata, uint64_t seed, int max_bounces, const std::string& polarization,
                       const std::string& footprint, const TraceStatistics& statistics, int num_batches,
                       double target_error_db, double error_db, const std::string& sampler) {
             return TraceFrame{start_time, trace_time,  as_vec3(transmitter, "transmitter"), as_vec3(receiver, "receiver"),
                               std::move(strata), seed, max_bounces, kPolarization.value_of(polarization),
                               kFootprint.value_of(footprint), kSampler.value_of(sampler), statistics, num_batches, target_error_db,
                               error_db};
           }),
           py::kw_only(), py::arg("start_time"), py::arg("trace_time"), py::arg("transmitter"), py::arg("receiver"),
           py::arg("strata"), py::arg("seed"), py::arg("max_bounces"), py::arg("polarization"), py::arg("footprint"),
           py::arg("statistics"), py::arg("num_batches") = 1, py::arg("target_error_db") = 0.0, py::arg("error_db") = 0.0,
           py::arg("sampler") = "lattice")
      .def_readonly("start_time", &TraceFrame::start_time, "s, first sample of the frame")
      .def_readonly("trace_time", &TraceFrame::trace_time, "s, the time that the rays saw")
      .def_property_readonly("transmitter", [](const TraceFrame& self) { return to_numpy(self.transmitter); },
                             "[3] m, where rays started, world")
      .def_property_readonly("receiver", [](const TraceFrame& self) { return to_numpy(self.receiver); },
                             "[3] m, where hits were connected to, world")
      .def_readonly("strata", &TraceFrame::strata, "list of Stratum")
      .def_readonly("seed", &TraceFrame::seed, "of directions and random phases")
      .def_readonly("max_bounces", &TraceFrame::max_bounces, "hits of a path at most")
      .def_property_readonly(
          "polarization", [](const TraceFrame& self) { return kPolarization.name_of(self.polarization); },
          "\"scalar\" or \"jones\"")
      .def_property_readonly("footprint", [](const TraceFrame& self) { return kFootprint.name_of(self.footprint); },
                             "\"second_order\", \"first_order\" or \"none\"")
      .def_readonly("num_batches", &TraceFrame::num_batches, "independent parts of the rays")
      .def_readonly("target_error_db", &TraceFrame::target_error_db,
                    "dB, error of the received power that was asked for; 0: none")
      .def_readonly("error_db", &TraceFrame::error_db,
                    "dB, the one that was reached, above the target where max_rays did not do; 0: not looked at")
      .def_property_readonly("sampler",
                             [](const TraceFrame& self) { return kSampler.name_of(self.sampler); },
                             "\"lattice\", \"fibonacci\", \"r2\" or \"random\"")
      .def_readonly("statistics", &TraceFrame::statistics, "TraceStatistics");
}

// --- Paths ---

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

template <class T>
auto path_column(std::vector<T> Paths::* field) {
  return [field](const py::object& self) { return numpy_view(self.cast<const Paths&>().*field, self); };
}

py::array hits_of(const py::object& self) {
  const auto& paths = self.cast<const Paths&>();
  return numpy_view(paths.num_hits() ? paths.hits->data() : nullptr, {static_cast<py::ssize_t>(paths.num_hits())}, self);
}

py::array curved_cell_of(const py::object& self) {
  const auto& cells = self.cast<const Paths&>().curved_cell;
  return numpy_view(cells.empty() ? nullptr : cells.front().data(), {static_cast<py::ssize_t>(cells.size()), 7}, self);
}

py::array jones_of(const py::object& self) {
  const auto& matrices = self.cast<const Paths&>().jones;
  const Shape shape{static_cast<py::ssize_t>(matrices.size()), 2, 2};
  return numpy_view(matrices.empty() ? nullptr : matrices.front().data(), shape, self);
}

constexpr int64_t kPathsPerBlock = 1 << 19;  // evaluated at a time where the paths are not all wanted at once

std::vector<int64_t> path_range(int64_t begin, int64_t end) {
  std::vector<int64_t> indices(static_cast<size_t>(end - begin));
  std::iota(indices.begin(), indices.end(), begin);
  return indices;
}

size_t antenna_index(const py::handle& value, const char* argument, size_t count) {
  const auto index = *checked_array<int64_t>(value, argument, "[]").data();
  if (index >= 0 && index < static_cast<int64_t>(count)) return static_cast<size_t>(index);
  throw std::out_of_range(std::string(argument) + ": must lie in 0 to " + std::to_string(count - 1) + ", got " +
                          std::to_string(index));
}

// The antenna of that index, or an isotropic one at a position [3] in m in the radar's frame.
Antenna antenna_of(const py::object& value, const char* argument, const std::vector<Antenna>& antennas) {
  if (py::isinstance<py::int_>(value)) return antennas[antenna_index(value, argument, antennas.size())];
  Antenna made;
  made.position = as_vec3(value, argument);
  return made;
}

struct Series {
  std::vector<double> lengths;                      // [T, P]
  std::vector<std::complex<double>> amplitudes;     // [T, P]
};

// Of all paths. Runs beside Python, so that Ctrl-C is answered.
Series evaluate_one_channel(const Paths& paths, const std::vector<double>& times, const Antenna& transmitter,
                            const Antenna& receiver, SpecularPoints specular = SpecularPoints::kMaterial) {
  return run_job("replay", py::none(), [&](Job& job) {
    Radar radar = paths.radar;
    radar.transmitters = {transmitter};
    radar.receivers = {receiver};
    ReplaySettings settings;
    settings.specular = specular;
    const Replayer replayer(paths, radar, settings);
    const std::vector<int64_t> indices = path_range(0, paths.num_paths());
    Series series;
    std::vector<double> lengths;
    std::vector<std::complex<double>> amplitudes;
    for (const double time : times) {
      replayer.evaluate(indices, time, lengths, amplitudes, &job);
      series.lengths.insert(series.lengths.end(), lengths.begin(), lengths.end());
      series.amplitudes.insert(series.amplitudes.end(), amplitudes.begin(), amplitudes.end());
    }
    return series;
  });
}

Shape series_shape(const Paths& paths, const std::vector<double>& times) {
  return {static_cast<py::ssize_t>(times.size()), static_cast<py::ssize_t>(paths.num_paths())};
}

py::array amplitudes_of(const Paths& paths, const py::object& times, const py::object& tx, const py::object& rx,
                        const std::string& replay) {
  const SpecularPoints specular = kSpecularPoints.value_of(replay);
  const std::vector<double> at = as_vector<double>(times, "times");
  const Antenna transmitter = paths.radar.transmitters[antenna_index(tx, "tx", paths.radar.transmitters.size())];
  const Antenna receiver = paths.radar.receivers[antenna_index(rx, "rx", paths.radar.receivers.size())];
  return numpy_take(evaluate_one_channel(paths, at, transmitter, receiver, specular).amplitudes, series_shape(paths, at));
}

py::array amplitude_of(const Paths& paths) {
  const Radar& radar = paths.radar;
  return numpy_take(
      evaluate_one_channel(paths, {paths.frame.trace_time}, radar.transmitters[0], radar.receivers[0]).amplitudes);
}

// In blocks: needs no more memory than the result.
py::array path_power_of(const Paths& paths) {
  return numpy_take(run_job("replay", py::none(), [&](Job& job) {
    Radar radar = paths.radar;
    radar.transmitters.resize(1);
    radar.receivers.resize(1);
    const Replayer replayer(paths, radar);
    std::vector<double> power, lengths;
    std::vector<std::complex<double>> amplitudes;
    power.reserve(static_cast<size_t>(paths.num_paths()));
    for (int64_t begin = 0; begin < paths.num_paths(); begin += kPathsPerBlock) {
      const std::vector<int64_t> block = path_range(begin, std::min(begin + kPathsPerBlock, paths.num_paths()));
      replayer.evaluate(block, paths.frame.trace_time, lengths, amplitudes, &job);
      for (const std::complex<double>& amplitude : amplitudes) power.push_back(std::norm(amplitude));
    }
    return power;
  }));
}

py::array lengths_of(const Paths& paths, const py::object& times, const py::object& transmitter, const py::object& receiver,
                     const std::string& replay) {
  const SpecularPoints specular = kSpecularPoints.value_of(replay);
  const std::vector<double> at = as_vector<double>(times, "times");
  const Antenna from = antenna_of(transmitter, "transmitter", paths.radar.transmitters);
  const Antenna to = antenna_of(receiver, "receiver", paths.radar.receivers);
  return numpy_take(evaluate_one_channel(paths, at, from, to, specular).lengths, series_shape(paths, at));
}

py::array points_of(const Paths& paths, double time) {
  std::vector<double> coordinates = run_job("points", py::none(), [&](Job& job) {
    const Pose pose(*paths.scene, time);
    std::vector<double> out(3 * static_cast<size_t>(paths.num_hits()));
    parallel_for((paths.num_hits() + kPathsPerBlock - 1) / kPathsPerBlock, [&](int64_t block) {
      const int64_t end = std::min((block + 1) * kPathsPerBlock, paths.num_hits());
      for (int64_t i = block * kPathsPerBlock; i < end; ++i) {
        const Hit& hit = (*paths.hits)[static_cast<size_t>(i)];
        const auto [a, b, c] = pose.world_triangle(hit.mesh_id, hit.triangle_id);
        Eigen::Map<Vec3>(out.data() + 3 * i) = a + double{hit.u} * (b - a) + double{hit.v} * (c - a);
      }
    }, &job);
    return out;
  });
  return numpy_take(std::move(coordinates), {static_cast<py::ssize_t>(paths.num_hits()), 3});
}

std::vector<uint8_t> as_mask(const py::array& mask) {
  const auto keep = checked_array<bool>(mask, "selection", "[P]");
  return std::vector<uint8_t>(keep.data(), keep.data() + keep.size());
}

PathsPtr select_mask(const Paths& paths, const py::array& mask) {
  const std::vector<uint8_t> keep = as_mask(mask);
  return run_job("select", py::none(), [&](Job& job) { return std::make_shared<Paths>(paths.select(keep, &job)); });
}

PathsPtr select_with_own_hits(const Paths& paths, const py::array& mask) {
  const std::vector<uint8_t> keep = as_mask(mask);
  return run_job("select", py::none(), [&](Job& job) {
    return std::make_shared<Paths>(paths.select(keep, &job).with_own_hits(&job));
  });
}

PathsPtr select_paths(const Paths& paths, const Selection& selection) {
  return run_job("select", py::none(), [&](Job& job) {
    return std::make_shared<Paths>(paths.select(selection.matches(paths, &job), &job));
  });
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

py::dict partition_paths(const Paths& paths, const py::dict& parts) {
  std::vector<NamedSelection> named;
  for (const auto& [name, selection] : parts) named.push_back({name.cast<std::string>(), selection.cast<Selection>()});
  Partition partition;
  const std::vector<PathsPtr> made = run_job("partition", py::none(), [&](Job& job) {
    partition = make_partition(paths, named, &job);
    return split(paths, partition, job);
  });
  py::dict out;
  for (size_t part = 0; part < made.size(); ++part) out[py::str(partition.names[part])] = made[part];
  return out;
}

PathsPtr paths_from_arrays(const py::array& hits, const py::array& offsets, const py::array& num_bounces,
                           const py::array& diffuse, const py::array& weight, const py::array& stratum,
                           const py::array& batch, const py::array& flags, const py::object& curved_cell, const py::object& jones, const Scene& scene, const Radar& radar,
                           const TraceFrame& frame) {
  auto paths = std::make_shared<Paths>();
  const py::array_t<Hit, py::array::c_style | py::array::forcecast> rows(hits);
  paths->hits = std::make_shared<const std::vector<Hit>>(rows.data(), rows.data() + rows.size());
  paths->offsets = as_vector<int64_t>(offsets, "offsets", "[P]");
  paths->num_bounces = as_vector<uint8_t>(num_bounces, "num_bounces", "[P]");
  paths->diffuse = as_vector<uint64_t>(diffuse, "diffuse", "[P]");
  paths->weight = as_vector<std::complex<float>>(weight, "weight", "[P]");
  paths->stratum = as_vector<uint8_t>(stratum, "stratum", "[P]");
  paths->batch = as_vector<uint8_t>(batch, "batch", "[P]");
  paths->flags = as_vector<uint32_t>(flags, "flags", "[P]");
  if (!curved_cell.is_none()) {
    const std::vector<float> cells = as_vector<float>(curved_cell, "curved_cell", "[P, 7]");
    paths->curved_cell.resize(cells.size() / 7);
    std::copy(cells.begin(), cells.end(), paths->curved_cell.empty() ? nullptr : paths->curved_cell.front().data());
  }
  if (!jones.is_none()) {
    const auto entries = as_vector<std::complex<float>>(jones, "jones", "[P, 2, 2]");
    paths->jones.resize(entries.size() / 4);
    std::copy(entries.begin(), entries.end(), paths->jones.empty() ? nullptr : paths->jones.front().data());
  }
  paths->scene = std::make_shared<const Scene>(scene);
  paths->radar = radar;
  paths->frame = frame;
  run_job("check", py::none(), [&](Job&) { paths->validate(); });
  return paths;
}

PathsPtr trace_paths(const Scene& scene, const Radar& radar, std::optional<int64_t> num_rays, int max_bounces,
                     uint64_t seed, double start_time, const std::string& polarization, const std::string& footprint,
                     const std::string& sampler, std::optional<int> batches, std::optional<double> target_error_db,
                     int64_t max_rays, const py::object& progress, const py::kwargs& unknown) {
  refuse_unknown(unknown, "trace", {"num_rays", "max_bounces", "seed", "start_time", "polarization", "footprint",
                                    "sampler", "batches", "target_error_db", "max_rays", "progress"});
  const Effort effort = effort_of(num_rays, batches, target_error_db, max_rays, kDefaultRays, 1);
  TraceSettings settings{effort.num_rays, max_bounces, seed, start_time, kPolarization.value_of(polarization),
                         kFootprint.value_of(footprint), effort.batches};
  settings.sampler = kSampler.value_of(sampler);
  auto paths = std::make_shared<Paths>(run_job("trace", progress, [&](Job& job) {
    return effort.target ? trace_to_error(scene, radar, settings, *effort.target, &job)
                         : trace(scene, radar, settings, &job);
  }));
  const TraceFrame& frame = paths->frame;
  if (frame.error_db > frame.target_error_db) {
    warn_of_missed_target("trace: max_rays", frame.error_db, frame.target_error_db);
  }
  return paths;
}

ReceivedPower power_of(const Paths& paths, int tx, int rx, const py::object& progress) {
  return run_job("received power", progress, [&](Job& job) { return received_power(paths, &job, {tx, rx}); });
}

std::string power_text(const ReceivedPower& self) {
  std::ostringstream text;
  text << "ReceivedPower(" << self.power << " W, standard_error=" << self.standard_error << " W)";
  return text.str();
}

void bind_received_power(py::module_& m) {
  py::class_<ReceivedPower>(m, "ReceivedPower",
                            R"(Mean received power of a set of paths and its Monte-Carlo error; all powers in W.

At the trace time, between two antennas, at the start frequency; the mean is over the random phases of diffuse
hits. Errors come from the batches of a trace (`trace(batches=8)`) and are NaN for one batch.)")
      .def_readonly("power", &ReceivedPower::power, "W, coherent + diffuse")
      .def_readonly("standard_error", &ReceivedPower::standard_error, "W, of the power")
      .def_readonly("coherent", &ReceivedPower::coherent,
                    "W, |field|^2 of coherent paths; with batches free of bias by noise, which can take it below zero")
      .def_readonly("coherent_error", &ReceivedPower::coherent_error, "W, standard error")
      .def_readonly("diffuse", &ReceivedPower::diffuse,
                    "W, sum over diffuse hits of |field of all paths over that hit|^2")
      .def_readonly("diffuse_error", &ReceivedPower::diffuse_error, "W, standard error")
      .def_readonly("resolved", &ReceivedPower::resolved,
                    "the power is at least twice its standard error; False for one batch")
      .def_readonly("num_batches", &ReceivedPower::num_batches, "independent parts of the rays behind the errors")
      .def_property_readonly("error_db", &ReceivedPower::error_db,
                             "dB, 10 log10(1 + standard_error / power); infinite where not resolved")
      .def("__repr__", &power_text);
  m.def("received_power", &power_of, py::arg("paths"), py::kw_only(), py::arg("tx") = 0, py::arg("rx") = 0,
        py::arg("progress") = py::none(),
        R"(Mean received power of paths with its standard error, for the whole of a trace or any selection of it.

paths: of a trace with batches for errors; progress: callable(stage, fraction) or None
tx, rx: indices of the antennas
Returns a ReceivedPower, in W. Raises IndexError for antennas that are not there, KeyboardInterrupt on Ctrl-C.)");
}

std::string paths_text(const Paths& self) {
  return "Paths(" + std::to_string(self.num_paths()) + " paths, " + std::to_string(self.num_hits()) + " hits)";
}

void bind_paths(py::module_& m) {
  PYBIND11_NUMPY_DTYPE(Hit, mesh_id, triangle_id, u, v);
  py::class_<Paths, PathsPtr>(m, "Paths", R"(The record of a trace: what every ray touched. Cannot be changed; its arrays are views.

Path i has the hits offsets[i] to offsets[i] + num_bounces[i], in order of travel from transmitter to receiver. Paths may
share hits; selections share all hits of their trace.)")
      .def_property_readonly("num_paths", &Paths::num_paths, "P, their number")
      .def_property_readonly("num_hits", &Paths::num_hits, "H, of all paths of the trace")
      .def_property_readonly("hits", &hits_of, "[H] structured: mesh_id, triangle_id, u, v")
      .def_property_readonly("mesh_id", hit_column(&Hit::mesh_id), "[H]")
      .def_property_readonly("triangle_id", hit_column(&Hit::triangle_id), "[H] triangle within the mesh")
      .def_property_readonly("u", hit_column(&Hit::u), "[H] barycentric: p = (1 - u - v) v0 + u v1 + v v2")
      .def_property_readonly("v", hit_column(&Hit::v), "[H] barycentric")
      .def_property_readonly("offsets", path_column(&Paths::offsets), "[P] first hit")
      .def_property_readonly("num_bounces", path_column(&Paths::num_bounces), "[P]")
      .def_property_readonly("diffuse", path_column(&Paths::diffuse), "[P] bit k: hit k is diffuse; 0: coherent")
      .def_property_readonly("weight", path_column(&Paths::weight), "[P] complex, what neither motion nor antennas change")
      .def_property_readonly("stratum", path_column(&Paths::stratum), "[P] index into frame.strata, 255: image method")
      .def_property_readonly("batch", path_column(&Paths::batch), "[P] batch of rays, 255: all of them (image method)")
      .def_property_readonly("flags", path_column(&Paths::flags), "[P] 1: recorded as the reversal of another path; else 0")
      .def_property_readonly("jones", &jones_of,
                             "[P, 2, 2] or [0, 2, 2] complex: (horizontal, vertical) at the receiver from the same at the transmitter")
      .def_property_readonly("curved_cell", &curved_cell_of,
                             "[P, 7] or [0, 7]: launch cells behind curved specular bounces (trace/paths.h); zeros on flat chains")
      .def_property_readonly("scene", [](const Paths& self) { return std::const_pointer_cast<Scene>(self.scene); },
                             "snapshot of the scene")
      .def_readonly("radar", &Paths::radar, "snapshot of the radar")
      .def_readonly("frame", &Paths::frame, "times, antenna positions, strata and settings of the trace")
      .def_property_readonly("amplitude", &amplitude_of,
                             "[P] complex, sqrt(W), at the trace time for the first antennas; without the phase of the length")
      .def_property_readonly("power", &path_power_of, "[P] W, |amplitude|^2")
      .def("amplitudes", &amplitudes_of, py::arg("times"), py::arg("tx") = 0, py::arg("rx") = 0,
           py::arg("replay") = "material",
           "Complex amplitudes [T, P] in sqrt(W) at `times` [T] in s for the transmitter tx and the receiver rx (indices); "
           "replay as in synthesize.")
      .def("lengths", &lengths_of, py::arg("times"), py::arg("transmitter") = 0, py::arg("receiver") = 0,
           py::arg("replay") = "material",
           "Lengths [T, P] in m at `times` [T] in s from transmitter to receiver: indices, or positions [3] in m in the radar's "
           "frame; replay as in synthesize.")
      .def("points", &points_of, py::arg("time"), "Hits [H, 3] in m in the world at `time` in s.")
      .def("select", &select_paths, py::arg("selection"), "The paths that `selection`, a path expression or a Selection, takes.")
      .def("select", &select_mask, py::arg("selection"), "The paths where `selection`, a mask bool [P], is true.")
      .def("_select_with_own_hits", &select_with_own_hits, py::arg("selection"),
           "The paths where a mask, bool [P], is true, with only the hits that they use.")
      .def("partition", &partition_paths, py::arg("parts"),
           "{name: Paths} of disjoint parts {name: selection}: the first that takes a path has it, the rest is \"other\".")
      .def_static("from_arrays", &paths_from_arrays, py::kw_only(), py::arg("hits"), py::arg("offsets"),
                  py::arg("num_bounces"), py::arg("diffuse"), py::arg("weight"), py::arg("stratum"), py::arg("batch"),
                  py::arg("flags"), py::arg("curved_cell") = py::none(), py::arg("jones") = py::none(),
                  py::arg("scene"), py::arg("radar"), py::arg("frame"),
                  R"(Paths of arrays as the properties give them.

hits: [H] structured; offsets, num_bounces, diffuse, weight, stratum, batch, flags: [P]; curved_cell: [P, 7] or None; jones:
[P, 2, 2] complex or None
scene, radar, frame: what they belong to
Raises ValueError where an index leads nowhere.)")
      .def("__len__", &Paths::num_paths)
      .def("__repr__", &paths_text);

  m.def("trace", &trace_paths, py::arg("scene"), py::arg("radar"), py::kw_only(), py::arg("num_rays") = py::none(),
        py::arg("max_bounces") = 4, py::arg("seed") = 1, py::arg("start_time") = 0.0, py::arg("polarization") = "scalar",
        py::arg("footprint") = "second_order", py::arg("sampler") = "lattice", py::arg("batches") = py::none(),
        py::arg("target_error_db") = py::none(), py::arg("max_rays") = kMaxRays, py::arg("progress") = py::none(),
        R"(Shoots rays from the radar through the scene at mid-frame and records what they hit.

num_rays: rays in all, 1 000 000 unless given; max_bounces: 1 to 64, hits on mirrors count. Between a target
and an antenna there are images over up to two mirrors each way; over mirrors alone, over as many as max_bounces
seed: the same seed gives the same bits
start_time: s, first sample of the frame
polarization: "scalar" (one coefficient a hit, TE or TM by the transmit polarisation; all antennas count as co-polarised) or
"jones" (field vectors, co- and cross-polar echoes; 32 bytes a path more)
footprint: filter of the ray's footprint on coherent echoes, "second_order", "first_order" or "none"
sampler: spreads the rays over the cone of each object, "lattice", "fibonacci", "r2" or "random"
batches: 1 to 64 independent lattices that share the rays, from which `received_power` tells standard errors; each is as
fine as its share of the rays; 1 unless given
target_error_db: dB; doubles the rays, from num_rays (16 384 unless given) to at most max_rays, until the error of the
received power is no larger: its standard error and what the last doubling changed. 8 batches unless given; a
RuntimeWarning and `paths.frame.error_db` tell where max_rays did not do
progress: callable(stage, fraction) or None
Returns Paths. Raises ValueError for bad settings, mirrors that are not flat, motions that do not cover the frame.)");
}

}  // namespace

void bind_trace(py::module_& m) {
  bind_frame(m);
  bind_paths(m);
  bind_received_power(m);
}

}  // namespace echopath::bindings
