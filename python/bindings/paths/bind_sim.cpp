#include <pybind11/complex.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cmath>
#include <string>

#include "call/run_job.h"
#include "call/warn.h"
#include "echopath/base/text/streamed.h"
#include "echopath/sim/decompose.h"
#include "echopath/sim/replay_cost.h"
#include "echopath/sim/stream/keyframes.h"
#include "echopath/sim/stream/part_pass.h"
#include "echopath/sim/synthesize.h"
#include "label/grouping.h"
#include "radar/window_name.h"
#include "values/array.h"
#include "values/choice.h"

namespace echopath::bindings {
namespace {

enum class Evaluation { kInterpolated, kChirps, kSamples };
constexpr auto kEvaluation = choice<Evaluation>("evaluate", "interpolated", "chirps", "samples");
constexpr auto kRetrace = choice<Retrace>("retrace", "never", "invalid", "always");

CubeSettings settings_of(double tolerance, const std::string& method, const std::string& replay, const std::string& evaluate,
                         double phase_tolerance, const std::string& retrace, int keyframes) {
  CubeSettings settings;
  settings.replay.specular = kSpecularPoints.value_of(replay);
  const Evaluation evaluation = kEvaluation.value_of(evaluate);
  settings.synthesis = {tolerance, kMethod.value_of(method), evaluation == Evaluation::kSamples};
  settings.replay.phase_tolerance = phase_tolerance;
  settings.replay.exact = evaluation == Evaluation::kChirps;
  settings.keyframes = {kRetrace.value_of(retrace), keyframes};
  return settings;
}

// Fills `probe`, unless it is None, with what the pass says.
void set_probe(SignalProbe* probe, CubeSettings& settings) {
  if (probe) *probe = {probe->seed, 0, {}};
  settings.probe = probe;
}

py::array cube_array(Cube&& cube) {
  return numpy_take(std::move(cube.values), {cube.num_tx, cube.num_rx, cube.num_chirps, cube.num_samples});
}

// New surface is looked for in some of many stretches.
void warn_of_few_searches(const CubeSettings& settings) {
  if (settings.keyframes.retrace != Retrace::kInvalid || settings.keyframes.keyframes <= kMaxSurfaceSearches) return;
  warn_caller(streamed("keyframes: new surface is looked for in ", kMaxSurfaceSearches, " of ", settings.keyframes.keyframes,
                       " stretches; what shows in none of these is left out, which retrace 'always' finds"));
}

// Long work is said beforehand. What interpolates in time is quick, and says nothing.
void warn_of_long_work(const Paths& paths, const Radar& radar, const CubeSettings& settings) {
  constexpr double kLong = 10.0;  // s
  const double of_stretches = keyframe_seconds(paths, settings.keyframes);
  if (of_stretches >= kLong) {
    warn_caller(streamed("keyframes: ", settings.keyframes.keyframes, " stretches with retrace '",
                         kRetrace.name_of(settings.keyframes.retrace), "' take about ", std::llround(of_stretches),
                         " s on this machine; fewer keyframes, or 0, which `validity` settles, are quicker"));
  }
  const double seconds = exact_seconds(paths, radar, settings);
  if (seconds < kLong) return;
  warn_caller(streamed("evaluate: '", settings.synthesis.per_sample ? "samples" : "chirps", "' takes about ",
                       std::llround(seconds), " s on this machine",
                       settings.keyframes.retrace == Retrace::kNever ? "" : ", more with keyframes", " for ",
                       paths.num_paths(), " paths; 'interpolated' is quick, with phases to phase_tolerance"));
}

// Binds call(paths, radar, settings, progress, extra...) with the settings of a signal behind its own arguments. A radar
// that is None is that of the trace.
template <class Result, class... Extra, class... Names>
void def_signal(py::module_& m, const char* name, const char* doc,
                Result (*call)(const Paths&, const Radar&, const CubeSettings&, const py::object&, Extra...),
                Names... names) {
  const auto bound = [call](const Paths& paths, const Radar* given, Extra... extra, double tolerance,
                            const std::string& method, const std::string& replay, const std::string& evaluate,
                            double phase_tolerance, const std::string& retrace, int keyframes, const py::object& progress,
                            SignalProbe* probe) {
    CubeSettings settings = settings_of(tolerance, method, replay, evaluate, phase_tolerance, retrace, keyframes);
    set_probe(probe, settings);
    const Radar& radar = given ? *given : paths.radar;
    warn_of_long_work(paths, radar, settings);
    warn_of_few_searches(settings);
    return call(paths, radar, settings, progress, extra...);
  };
  m.def(name, bound, py::arg("paths"), names..., py::kw_only(), py::arg("tolerance") = 1e-7, py::arg("method") = "auto",
        py::arg("replay") = "material", py::arg("evaluate") = "interpolated",
        py::arg("phase_tolerance") = ReplaySettings{}.phase_tolerance, py::arg("retrace") = "never",
        py::arg("keyframes") = 0, py::arg("progress") = py::none(), py::arg("probe") = py::none(), doc);
}

py::array synthesize_cube(const Paths& paths, const Radar& radar, const CubeSettings& settings, const py::object& progress) {
  return cube_array(run_job("synthesize", progress, [&](Job& job) { return synthesize(paths, radar, settings, &job); }));
}

py::list decompose_cubes(const Paths& paths, const Radar& radar, const CubeSettings& settings, const py::object& progress,
                         std::vector<KeyedGrouping> views) {
  std::vector<Grouping> rules;
  for (const KeyedGrouping& view : views) rules.push_back(view.rule);
  auto cubes = run_job("decompose", progress, [&](Job& job) { return decompose(paths, radar, rules, settings, &job); });
  py::list out;
  for (size_t view = 0; view < views.size(); ++view) {
    py::dict parts;
    for (PartCube& part : cubes[view]) parts[views[view].key_of(part.name)] = cube_array(std::move(part.cube));
    out.append(parts);
  }
  return out;
}

std::unique_ptr<PartPass> part_pass(const Paths& paths, const Radar& radar, const py::object& group, uint32_t num_groups,
                                    double tolerance, const std::string& method, const std::string& replay,
                                    const std::string& evaluate, double phase_tolerance, SignalProbe* probe) {
  CubeSettings settings = settings_of(tolerance, method, replay, evaluate, phase_tolerance, "never", 0);
  set_probe(probe, settings);
  warn_of_long_work(paths, radar, settings);
  warn_of_few_searches(settings);
  return std::make_unique<PartPass>(paths, radar, as_vector<uint32_t>(group, "group"), num_groups, settings);
}

py::list powers_of_pass(PartPass& pass, const PartPass::Sets& sets, const py::object& window, int zero_pad, double least,
                        const py::object& progress, const PartPass::Ranges& ranges) {
  const MapWindows taper = as_map_windows(window);
  py::list out;
  for (SetPower& of_set :
       run_job("families", progress, [&](Job& job) { return pass.powers(sets, taper, zero_pad, least, &job, ranges); })) {
    out.append(py::make_tuple(numpy_take(std::move(of_set.cells)), of_set.mean_square));
  }
  return out;
}

py::list cubes_of_pass(PartPass& pass, const PartPass::Sets& sets, const py::object& progress) {
  py::list out;
  for (Cube& cube : run_job("families", progress, [&](Job& job) { return pass.cubes(sets, &job); })) {
    out.append(cube_array(std::move(cube)));
  }
  return out;
}

py::array bounds_of_pass(PartPass& pass, const PartPass::Sets& sets, const py::object& window, int zero_pad,
                         const py::object& progress) {
  const MapWindows taper = as_map_windows(window);
  std::vector<double> bounds =
      run_job("families", progress, [&](Job& job) { return pass.bounds(sets, taper, zero_pad, &job); });
  const auto rows = std::ssize(sets);
  const py::ssize_t columns = rows > 0 ? std::ssize(bounds) / rows : 0;
  return numpy_take(std::move(bounds), {rows, columns});
}

void bind_part_pass(py::module_& m) {
  py::class_<PartPass>(m, "PartPass", R"(The signals of many groups of paths, some of them at a time.

Each path is replayed when its group is asked for; signals that are asked for while adds_up is set add up to the whole, each
of which is to be asked for once.)")
      .def(py::init(&part_pass), py::keep_alive<1, 2>(), py::keep_alive<1, 3>(), py::keep_alive<1, 11>(), py::arg("paths"),
           py::arg("radar"), py::arg("group"), py::arg("num_groups"), py::kw_only(), py::arg("tolerance"), py::arg("method"),
           py::arg("replay"), py::arg("evaluate"), py::arg("phase_tolerance"), py::arg("probe") = py::none(),
           "group: uint32 [P] below num_groups; the other arguments are those of ep.synthesize.")
      .def("set_adds_up", &PartPass::set_adds_up, py::arg("adds_up"), "Whether signals add to the whole; at first they do.")
      .def_property_readonly("group_bytes", &PartPass::group_bytes, "memory of one group while its signal is made")
      .def(
          "whole",
          [](const PartPass& self) {
            return cube_array(run_job("families", py::none(), [&](Job& job) { return self.whole(&job); }));
          },
          "The sum of the signals that were added, [tx, rx, chirp, sample] in sqrt(W).")
      .def(
          "finish_probe",
          [](PartPass& self) { run_job("families", py::none(), [&](Job& job) { self.finish_probe(&job); }); },
          "Fills the probe; to be called once, when all groups were added.")
      .def("powers", &powers_of_pass, py::arg("sets"), py::arg("window"), py::arg("zero_pad"), py::arg("least"),
           py::arg("progress"), py::arg("ranges") = PartPass::Ranges(),
           R"(Powers of sets of groups in the cells of a range-Doppler map.

sets: lists of groups whose fields add up; least: cells at ranges where one can show no more than that, in W, may be 0;
ranges: of each set, 1 or 0 [R], whether cells of that range are asked for: the others may have no power; empty: all are.
Returns for each (power [V * R] in W, mean over the channels, mean square of its
samples in W, which sets of several groups do not have: 0).)")
      .def("cubes", &cubes_of_pass, py::arg("sets"), py::arg("progress"),
           "Signals [tx, rx, chirp, sample] of sets of groups.")
      .def("bounds", &bounds_of_pass, py::arg("sets"), py::arg("window"), py::arg("zero_pad"), py::arg("progress"),
           R"(Adds sets of groups to the whole and bounds what each can show, [set, R] in W, at any velocity or azimuth.

cpp/echopath/sim/cells/cell_bounds.h has the rule.)");
}

}  // namespace

void bind_sim(py::module_& m) {
  bind_part_pass(m);
  m.attr("PHASE_TOLERANCE") = ReplaySettings{}.phase_tolerance;
  const auto amplitude_tolerance = [](double phase_tolerance) {
    return ReplaySettings{.phase_tolerance = phase_tolerance}.amplitude_tolerance();
  };
  m.def("amplitude_tolerance", amplitude_tolerance, py::arg("phase_tolerance"),
        "Aim for interpolated amplitudes, relative to the largest of each path, beside one for phases in rad.");
  def_signal(m, "synthesize", "What ep.synthesize calls.", &synthesize_cube, py::arg("radar") = py::none());
  def_signal(m, "decompose", R"(The signals of parts of the paths, several views of them replayed once.

views: list of Grouping
Returns a list of {key: cube}, one for each view, the cubes [tx, rx, chirp, sample] of each adding up to the whole. The other
arguments are those of ep.synthesize.)",
             &decompose_cubes, py::arg("radar"), py::arg("views"));
}

}  // namespace echopath::bindings
