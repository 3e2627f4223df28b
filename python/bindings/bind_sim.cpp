#include <pybind11/complex.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cmath>
#include <sstream>
#include <string>

#include "array.h"
#include "choice.h"
#include "echopath/sim/decompose.h"
#include "echopath/sim/replay_cost.h"
#include "echopath/sim/synthesize.h"
#include "grouping.h"
#include "run_job.h"
#include "warn.h"

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

// None: the radar of the trace.
const Radar& radar_or_own(const Paths& paths, const Radar* radar) { return radar ? *radar : paths.radar; }

// Long work is said beforehand. What interpolates in time is quick, and says nothing.
void warn_of_long_work(const Paths& paths, const Radar& radar, const CubeSettings& settings) {
  constexpr double kLong = 10.0;  // s
  const double of_stretches = keyframe_seconds(paths, settings.keyframes);
  if (of_stretches >= kLong) {
    std::ostringstream told;
    told << "keyframes: " << settings.keyframes.keyframes << " stretches with retrace '"
         << kRetrace.name_of(settings.keyframes.retrace) << "' take about " << std::llround(of_stretches)
         << " s on this machine; fewer keyframes, or 0, which `validity` "
         << "settles, are quicker";
    warn_caller(told.str());
  }
  const double seconds = exact_seconds(paths, radar, settings);
  if (seconds < kLong) return;
  std::ostringstream text;
  text << "evaluate: '" << (settings.synthesis.per_sample ? "samples" : "chirps") << "' takes about "
       << std::llround(seconds) << " s on this machine"
       << (settings.keyframes.retrace == Retrace::kNever ? "" : ", more with keyframes") << " for " << paths.num_paths()
       << " paths; 'interpolated' is quick, with phases to phase_tolerance";
  warn_caller(text.str());
}

py::array synthesize_cube(const Paths& paths, const Radar* radar, double tolerance, const std::string& method,
                          const std::string& replay, const std::string& evaluate, double phase_tolerance,
                          const std::string& retrace, int keyframes, const py::object& progress, SignalProbe* probe) {
  CubeSettings settings = settings_of(tolerance, method, replay, evaluate, phase_tolerance, retrace, keyframes);
  set_probe(probe, settings);
  warn_of_long_work(paths, radar_or_own(paths, radar), settings);
  return cube_array(run_job("synthesize", progress,
                            [&](Job& job) { return synthesize(paths, radar_or_own(paths, radar), settings, &job); }));
}

py::list decompose_cubes(const Paths& paths, const Radar* radar, const std::vector<KeyedGrouping>& views, double tolerance,
                         const std::string& method, const std::string& replay, const std::string& evaluate,
                         double phase_tolerance, const std::string& retrace, int keyframes, const py::object& progress,
                         SignalProbe* probe) {
  CubeSettings settings = settings_of(tolerance, method, replay, evaluate, phase_tolerance, retrace, keyframes);
  set_probe(probe, settings);
  warn_of_long_work(paths, radar_or_own(paths, radar), settings);
  std::vector<Grouping> rules;
  for (const KeyedGrouping& view : views) rules.push_back(view.rule);
  auto cubes = run_job("decompose", progress,
                       [&](Job& job) { return decompose(paths, radar_or_own(paths, radar), rules, settings, &job); });
  py::list out;
  for (size_t view = 0; view < views.size(); ++view) {
    py::dict parts;
    for (PartCube& part : cubes[view]) parts[views[view].key_of(part.name)] = cube_array(std::move(part.cube));
    out.append(parts);
  }
  return out;
}

}  // namespace

void bind_sim(py::module_& m) {
  const ReplaySettings aims;
  m.attr("PHASE_TOLERANCE") = aims.phase_tolerance;
  m.attr("AMPLITUDE_TOLERANCE") = aims.amplitude_tolerance;
  m.def("synthesize", &synthesize_cube, py::arg("paths"), py::arg("radar") = py::none(), py::kw_only(),
        py::arg("tolerance") = 1e-7, py::arg("method") = "auto", py::arg("replay") = "material",
        py::arg("evaluate") = "interpolated", py::arg("phase_tolerance") = aims.phase_tolerance,
        py::arg("retrace") = "never", py::arg("keyframes") = 0, py::arg("progress") = py::none(),
        py::arg("probe") = py::none(), "What ep.synthesize calls.");
  m.def("decompose", &decompose_cubes, py::arg("paths"), py::arg("radar"), py::arg("views"), py::kw_only(),
        py::arg("tolerance") = 1e-7, py::arg("method") = "auto", py::arg("replay") = "material",
        py::arg("evaluate") = "interpolated", py::arg("phase_tolerance") = aims.phase_tolerance,
        py::arg("retrace") = "never", py::arg("keyframes") = 0, py::arg("progress") = py::none(),
        py::arg("probe") = py::none(),
        R"(The signals of parts of the paths, several views of them replayed once.

views: list of Grouping
Returns a list of {key: cube}, one for each view, the cubes [tx, rx, chirp, sample] of each adding up to the whole. radar,
The other arguments are those of ep.synthesize.)");
}

}  // namespace echopath::bindings
