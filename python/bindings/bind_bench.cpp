#include <pybind11/complex.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <complex>
#include <string>
#include <utility>

#include "call/run_job.h"
#include "echopath/bench/bare_queries.h"
#include "echopath/bench/moved_geometry.h"
#include "echopath/bench/replay_only.h"
#include "echopath/bench/single_rays.h"
#include "echopath/bench/synthesis_trial.h"
#include "values/array.h"
#include "values/choice.h"

namespace echopath::bindings {
namespace {

py::dict time_bare_queries(Scene scene, const Radar& radar, int64_t num_rays, int max_bounces, uint64_t seed,
                           int repetitions) {
  TraceSettings settings;
  settings.num_rays = num_rays;
  settings.max_bounces = max_bounces;
  settings.seed = seed;
  const BareQueries found = run_job(
      "queries", py::none(), [&](Job& job) { return measure_bare_queries(scene, radar, settings, repetitions, &job); });
  py::dict out;
  out["num_rays"] = found.num_rays;
  out["num_paths"] = found.num_paths;
  out["num_queries"] = found.num_queries;
  out["num_in_packets"] = found.num_in_packets;
  out["num_shadow"] = found.num_shadow;
  out["build_seconds"] = found.build_seconds;
  const auto seconds = [](const BareQueries::Seconds& of) {
    return py::dict(py::arg("elapsed") = of.elapsed, py::arg("processor") = of.processor);
  };
  out["trace_seconds"] = seconds(found.trace);
  out["bare_seconds"] = seconds(found.bare);
  out["single_seconds"] = seconds(found.single);
  return out;
}

py::dict time_moved_geometry(Scene scene, const py::object& times) {
  const auto at = as_vector<double>(times, "times", "[T]");
  const MovedGeometry found = run_job("geometry", py::none(), [&](Job&) { return measure_moved_geometry(scene, at); });
  return py::dict(py::arg("first") = found.first, py::arg("again") = found.again, py::arg("bare") = found.bare);
}

py::tuple synthesis_trial(const ChirpSequence& waveform, const py::object& delays, const py::object& amplitudes,
                          const std::string& method, double tolerance) {
  const auto delay = checked_array<double>(delays, "delays", "[K, P]");
  const Echoes echoes = trial_echoes(waveform, static_cast<int>(delay.shape(0)), {delay.data(), delay.data() + delay.size()},
                                     as_vector<std::complex<double>>(amplitudes, "amplitudes", "[K, P]"));
  const SynthesisOptions options{tolerance, kMethod.value_of(method)};
  SynthesisTrial trial =
      run_job("synthesize", py::none(), [&](Job& job) { return try_synthesis(waveform, echoes, options, &job); });
  return py::make_tuple(trial.elapsed, trial.processor,
                        numpy_take(std::move(trial.samples), {waveform.num_chirps, waveform.num_samples}));
}

int64_t time_replay(const Paths& paths, const Radar& radar, double phase_tolerance) {
  ReplaySettings settings;
  settings.phase_tolerance = phase_tolerance;
  return run_job("replay", py::none(), [&](Job& job) { return replay_only(paths, radar, settings, &job); });
}

py::tuple hits_of_rays(Scene scene, const py::object& origins, const py::object& directions, double time) {
  const std::vector<Vec3> from = as_points(origins, "origins"), along = as_points(directions, "directions");
  RayAnswers found = run_job("first_hits", py::none(), [&](Job& job) { return first_hits(scene, time, from, along, &job); });
  return py::make_tuple(numpy_take(std::move(found.mesh_id)), numpy_take(std::move(found.triangle_id)),
                        numpy_take(std::move(found.distance)), numpy_take(std::move(found.is_false)));
}

py::array blocked(Scene scene, const py::object& starts, const py::object& ends, double time) {
  const std::vector<Vec3> from = as_points(starts, "starts"), to = as_points(ends, "ends");
  return numpy_take(run_job("blocked", py::none(), [&](Job& job) { return blocked_segments(scene, time, from, to, &job); }));
}

void bind_times(py::module_& m) {
  m.def("bare_queries", &time_bare_queries, py::arg("scene"), py::arg("radar"), py::kw_only(), py::arg("num_rays"),
        py::arg("max_bounces") = 4, py::arg("seed") = 1, py::arg("repetitions") = 5,
        R"(Times a trace beside its own queries, asked again in a bare loop.

num_rays, max_bounces, seed: as in trace; repetitions: measurements, in turn
Returns a dict: num_rays, num_paths, num_queries (num_in_packets and num_shadow of them), build_seconds (once) and
trace_seconds (rays and record), bare_seconds (queries packed alike) and single_seconds (one by one), each a dict of lists
[repetitions] in s: elapsed, and processor of all threads together.)");
  m.def("moved_geometry", &time_moved_geometry, py::arg("scene"), py::arg("times"),
        R"(Times what it costs to bring the geometry of a scene from time to time.

times: [T] in s, the first one builds it
Returns a dict of s of the processor: first; again [T - 1]; bare [T - 1], Embree alone with a tree for each mesh, of which those
that move are fitted. Raises ValueError naming the argument.)");
  m.def("replay_only", &time_replay, py::arg("paths"), py::arg("radar"), py::kw_only(),
        py::arg("phase_tolerance") = ReplaySettings{}.phase_tolerance,
        "What replay costs without synthesis: evaluates all paths at all chirps and channels, one echo for paths over the "
        "same "
        "hits as synthesis has them, and returns how many path-chirps that were.");
  m.def(
      "trial_node_times",
      [](const ChirpSequence& waveform, int num_nodes) { return to_numpy(trial_node_times(waveform, num_nodes)); },
      py::arg("waveform"), py::arg("num_nodes"), "Times [num_nodes] in s of the nodes of synthesis_trial.");
  m.def("synthesis_trial", &synthesis_trial, py::arg("waveform"), py::arg("delays"), py::arg("amplitudes"), py::kw_only(),
        py::arg("method") = "auto", py::arg("tolerance") = SynthesisOptions{}.tolerance,
        "What synthesis of echoes costs that polynomials give over a frame: delays [K, P] in s and amplitudes [K, P] in "
        "sqrt(W) at trial_node_times -> (wall seconds, processor seconds, samples [chirp, sample]).");
}

void bind_rays(py::module_& m) {
  m.def("first_hits", &hits_of_rays, py::arg("scene"), py::arg("origins"), py::arg("directions"), py::kw_only(),
        py::arg("time") = 0.0,
        R"(What rays meet first, as the trace sees it, to be compared with other ray tracers.

origins: [N, 3] in m, world; directions: [N, 3], any length; time: s
Returns (mesh_id [N], 2^32 - 1 for none; triangle_id [N]; distance [N] in m; is_false [N], 1: found, but not confirmed in
double precision). Raises ValueError naming the argument.)");
  m.def("blocked", &blocked, py::arg("scene"), py::arg("starts"), py::arg("ends"), py::kw_only(), py::arg("time") = 0.0,
        R"(Whether something lies on the open segments between points, as the trace sees it.

starts, ends: [N, 3] in m, world; time: s
Returns [N], 1: blocked. Raises ValueError naming the argument.)");
}

}  // namespace

void bind_bench(py::module_& core) {
  py::module_ m = core.def_submodule("bench", "What `echopath bench` alone needs of the core.");
  bind_times(m);
  bind_rays(m);
}

}  // namespace echopath::bindings
