#include <pybind11/complex.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <ctime>
#include <string>

#include "array.h"
#include "choice.h"
#include "echopath/replay/time/frame_nodes.h"
#include "echopath/sim/decompose.h"
#include "echopath/sim/replay_stream.h"
#include "echopath/sim/synthesize.h"
#include "grouping.h"
#include "keywords.h"
#include "run_job.h"

namespace echopath::bindings {
namespace {

const std::vector<std::string> kSynthesisKeywords = {"tolerance", "method", "replay", "evaluate", "phase_tolerance",
                                            "retrace", "keyframes", "progress", "probe"};

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

py::array synthesize_cube(const Paths& paths, const Radar* radar, double tolerance, const std::string& method,
                          const std::string& replay, const std::string& evaluate, double phase_tolerance,
                          const std::string& retrace, int keyframes, const py::object& progress, SignalProbe* probe,
                          const py::kwargs& unknown) {
  refuse_unknown(unknown, "synthesize", kSynthesisKeywords);
  CubeSettings settings = settings_of(tolerance, method, replay, evaluate, phase_tolerance, retrace, keyframes);
  set_probe(probe, settings);
  return cube_array(run_job("synthesize", progress, [&](Job& job) {
    return synthesize(paths, radar_or_own(paths, radar), settings, &job);
  }));
}

py::list decompose_cubes(const Paths& paths, const Radar* radar, const std::vector<KeyedGrouping>& views, double tolerance,
                         const std::string& method, const std::string& replay, const std::string& evaluate,
                         double phase_tolerance, const std::string& retrace, int keyframes, const py::object& progress,
                         SignalProbe* probe, const py::kwargs& unknown) {
  refuse_unknown(unknown, "decompose", kSynthesisKeywords);
  CubeSettings settings = settings_of(tolerance, method, replay, evaluate, phase_tolerance, retrace, keyframes);
  set_probe(probe, settings);
  std::vector<Grouping> rules;
  for (const KeyedGrouping& view : views) rules.push_back(view.rule);
  auto cubes = run_job("decompose", progress, [&](Job& job) {
    return decompose(paths, radar_or_own(paths, radar), rules, settings, &job);
  });
  py::list out;
  for (size_t view = 0; view < views.size(); ++view) {
    py::dict parts;
    for (PartCube& part : cubes[view]) parts[views[view].key_of(part.name)] = cube_array(std::move(part.cube));
    out.append(parts);
  }
  return out;
}

// One antenna pair, whose frame the nodes of a trial span.
Radar radar_of(const ChirpSequence& waveform) {
  Radar radar;
  radar.waveform = waveform;
  radar.transmitters.resize(1);
  radar.receivers.resize(1);
  return radar;
}

FrameNodes trial_nodes(const Radar& radar, py::ssize_t num_nodes) {
  return num_nodes == 1 ? static_nodes(radar, 0.0) : chebyshev_nodes(radar, 0.0, {}, static_cast<int>(num_nodes));
}

Echoes trial_echoes(const ChirpSequence& waveform, const py::object& delays, const py::object& amplitudes) {
  const auto delay = checked_array<double>(delays, "delays", "[K, P]");
  const auto amplitude = checked_array<std::complex<double>>(amplitudes, "amplitudes", "[K, P]");
  Echoes echoes;
  echoes.sampling = trial_nodes(radar_of(waveform), delay.shape(0)).sampling.front();
  echoes.num_echoes = delay.shape(1);
  echoes.delay.assign(delay.data(), delay.data() + delay.size());
  echoes.amplitude.assign(amplitude.data(), amplitude.data() + amplitude.size());
  return echoes;
}

double seconds_of(clockid_t clock) {
  timespec now;
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

py::tuple synthesis_trial(const ChirpSequence& waveform, const py::object& delays, const py::object& amplitudes,
                          const std::string& method, double tolerance) {
  const Echoes echoes = trial_echoes(waveform, delays, amplitudes);
  const SynthesisOptions options{tolerance, kMethod.value_of(method)};
  double wall = 0.0, processor = 0.0;
  auto samples = run_job("synthesize", py::none(), [&](Job& job) {
    const double wall_begin = seconds_of(CLOCK_MONOTONIC), processor_begin = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
    Synthesizer synthesizer(waveform, 1, 1, echoes.num_echoes, options);
    synthesizer.add(0, echoes, &job);
    auto cube = synthesizer.cube(0, &job);
    wall = seconds_of(CLOCK_MONOTONIC) - wall_begin;
    processor = seconds_of(CLOCK_PROCESS_CPUTIME_ID) - processor_begin;
    return cube;
  });
  return py::make_tuple(wall, processor, numpy_take(std::move(samples), {waveform.num_chirps, waveform.num_samples}));
}

}  // namespace

void bind_sim(py::module_& m) {
  const ReplaySettings aims;
  m.attr("PHASE_TOLERANCE") = aims.phase_tolerance;
  m.attr("AMPLITUDE_TOLERANCE") = aims.amplitude_tolerance;
  m.def("trial_node_times", [](const ChirpSequence& waveform, int num_nodes) {
    return to_numpy(trial_nodes(radar_of(waveform), num_nodes).times);
  }, py::arg("waveform"), py::arg("num_nodes"), "Times [num_nodes] in s of the nodes of synthesis_trial.");
  m.def("synthesis_trial", &synthesis_trial, py::arg("waveform"), py::arg("delays"), py::arg("amplitudes"), py::kw_only(),
        py::arg("method") = "auto", py::arg("tolerance") = 1e-7,
        "What synthesis of echoes costs that polynomials give over a frame, for benchmarks: delays [K, P] in s and "
        "amplitudes [K, P] in sqrt(W) at trial_node_times -> (wall seconds, processor seconds, samples [chirp, sample]).");
  m.def("replay_only", [](const Paths& paths, const Radar& radar, double phase_tolerance) {
    ReplaySettings settings;
    settings.phase_tolerance = phase_tolerance;
    return run_job("replay", py::none(), [&](Job& job) { return replay_only(paths, radar, settings, &job); });
  }, py::arg("paths"), py::arg("radar"), py::kw_only(), py::arg("phase_tolerance") = aims.phase_tolerance,
        "What replay costs without synthesis, for benchmarks: evaluates all paths at all chirps and channels, one echo for "
        "paths over the same hits as synthesis has them, and returns how many path-chirps that were.");
  m.def("replay_error", [](const Paths& paths, const Radar& radar, const std::vector<int>& chirps, double phase_tolerance) {
    ReplaySettings settings;
    settings.phase_tolerance = phase_tolerance;
    const ReplayError error =
        run_job("replay", py::none(), [&](Job& job) { return replay_error(paths, radar, settings, chirps, &job); });
    return py::make_tuple(error.phase, error.amplitude);
  }, py::arg("paths"), py::arg("radar"), py::arg("chirps"), py::kw_only(), py::arg("phase_tolerance") = aims.phase_tolerance,
        "How far interpolated paths are from paths evaluated at these chirps, for benchmarks: largest errors of phase (rad) "
        "and of amplitude (share).");
  m.def("synthesize", &synthesize_cube, py::arg("paths"), py::arg("radar") = py::none(), py::kw_only(),
        py::arg("tolerance") = 1e-7, py::arg("method") = "auto", py::arg("replay") = "material",
        py::arg("evaluate") = "interpolated", py::arg("phase_tolerance") = aims.phase_tolerance,
        py::arg("retrace") = "never", py::arg("keyframes") = 0, py::arg("progress") = py::none(),
        py::arg("probe") = py::none(),
        R"(The noise-free IF signal of paths.

radar: another waveform, array or motion than that of the trace, or None
tolerance: rms error of the samples relative to the sum of all |amplitudes|, 1e-13 to 0.1
method: "auto", "direct" (the reference), "recurrence" or "nufft"
replay: where specular hits on surfaces that are no mirrors stand: "material" (where the trace found them, moving with their
    triangles) or "fermat" (one Newton step from there to the moved point of reflection, for each antenna)
evaluate: "interpolated" (by polynomials in time: lengths to phase_tolerance in rad, amplitudes to 1e-4 of the largest of
    each path), "chirps" (in every chirp: the reference), or "samples" (interpolated, and moving echoes with the delay of
    every sample: for fast rotors, a sine and a cosine per path and sample)
retrace: for each of `keyframes` stretches of chirps, "never" (one record serves the frame), "invalid" (shadows and points of
    reflection are renewed, see `renew`; surface that comes into view gets paths of its own if `paths` are those of a whole
    trace, and none if they are a selection) or "always" (the scene is traced anew with the same settings and seed; random
    phases of rough surfaces then differ from one stretch to the next, which suits coherent echoes; not for selections)
keyframes: number of stretches, 1 to num_chirps; 0: as many as `validity` suggests
progress: callable(stage, fraction) or None
probe: a SignalProbe, filled with spot checks of this signal, or None
Returns the cube [tx, rx, chirp, sample], complex128 in sqrt(W).)");
  m.def("decompose", &decompose_cubes, py::arg("paths"), py::arg("radar"), py::arg("views"), py::kw_only(),
        py::arg("tolerance") = 1e-7, py::arg("method") = "auto", py::arg("replay") = "material",
        py::arg("evaluate") = "interpolated", py::arg("phase_tolerance") = aims.phase_tolerance,
        py::arg("retrace") = "never", py::arg("keyframes") = 0, py::arg("progress") = py::none(),
        py::arg("probe") = py::none(),
        R"(The signals of parts of the paths, several views of them replayed once.

views: list of Grouping
Returns a list of {key: cube}, one for each view, the cubes [tx, rx, chirp, sample] of each adding up to the whole. radar,
tolerance, method, replay, evaluate, phase_tolerance, retrace, keyframes, progress and probe are as in synthesize.)");
}

}  // namespace echopath::bindings
