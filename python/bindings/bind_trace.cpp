#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "array.h"
#include "choice.h"
#include "echopath/sim/rays/ray_allocation.h"
#include "echopath/trace/geometry/kept_geometry.h"
#include "echopath/trace/trace.h"
#include "error_target.h"
#include "keywords.h"
#include "run_job.h"

namespace echopath::bindings {
namespace {

using PathsPtr = std::shared_ptr<Paths>;

// A number of rays is a budget; who names neither it nor a target gets the target of ErrorTarget.
Effort effort_of(std::optional<int64_t> num_rays, int batches, std::optional<double> target_error_db, int64_t max_rays) {
  if (target_error_db) return toward(ErrorTarget{*target_error_db, max_rays}, num_rays, batches);
  if (num_rays) return {*num_rays, batches, std::nullopt};
  ErrorTarget target;
  target.floor = EchoFloor::kNoise;
  target.max_rays = std::min(max_rays, kMaxDefaultRays);
  return toward(target, std::nullopt, batches);
}

PathsPtr trace_paths(Scene scene, const Radar& radar, std::optional<int64_t> num_rays, int max_bounces, uint64_t seed,
                     double start_time, const std::string& polarization, const std::string& footprint,
                     const std::string& sampler, std::optional<int> batches, std::optional<double> target_error_db,
                     int64_t max_rays, const py::object& progress, KeptGeometry* kept, const py::kwargs& unknown) {
  refuse_unknown(unknown, "trace",
                 {"num_rays", "max_bounces", "seed", "start_time", "polarization", "footprint", "sampler", "batches",
                  "target_error_db", "max_rays", "progress"});
  const Effort effort = effort_of(num_rays, batches.value_or(1), target_error_db, max_rays);
  TraceSettings settings;
  settings.num_rays = effort.num_rays;
  settings.max_bounces = max_bounces;
  settings.seed = seed;
  settings.start_time = start_time;
  settings.polarization = kPolarization.value_of(polarization);
  settings.footprint = kFootprint.value_of(footprint);
  settings.batches = effort.batches;
  settings.sampler = kSampler.value_of(sampler);
  auto paths = std::make_shared<Paths>(run_job("trace", progress, [&](Job& job) {
    return effort.target ? trace_to_error(scene, radar, settings, *effort.target, &job, kept)
                         : trace_by_need(scene, radar, settings, &job, kept);
  }));
  const TraceFrame& frame = paths->frame;
  if (target_error_db && frame.error_db > frame.target_error_db) {
    warn_of_missed_target("trace: max_rays", frame.error_db, frame.target_error_db);
  }
  return paths;
}

}  // namespace

void bind_trace(py::module_& m) {
  py::class_<KeptGeometry, std::shared_ptr<KeptGeometry>>(
      m, "KeptGeometry", "Geometry that goes from one trace of a scene to the next, no part of the public interface.")
      .def(py::init<>());

  m.def("trace", &trace_paths, py::arg("scene"), py::arg("radar"), py::kw_only(), py::arg("num_rays") = py::none(),
        py::arg("max_bounces") = 4, py::arg("seed") = 1, py::arg("start_time") = 0.0, py::arg("polarization") = "scalar",
        py::arg("footprint") = "second_order", py::arg("sampler") = "lattice", py::arg("batches") = py::none(),
        py::arg("target_error_db") = py::none(), py::arg("max_rays") = kMaxRays, py::arg("progress") = py::none(),
        py::arg("kept") = py::none(),
        R"(Shoots rays from the radar through the scene at mid-frame and records what they hit.

num_rays: a budget of rays. They go where the error is: a pilot of an eighth as many beside them, which is thrown away, tells how
many the echo of each object, and of each of its images, needs to be known to 0.3 dB; moving objects get more; up to half of
those of each lie closer about its points of reflection (strata with focus_of). Unless given,
and without target_error_db, there are as many as bring the echo of each object that stands above the noise to 0.3 dB (95 %
interval of bias and chance), 1 000 000 at most; max_bounces: 1 to 64, hits on mirrors count. Between a target
and an antenna there are images over up to two mirrors each way; over mirrors alone, over as many as max_bounces
seed: the same seed gives the same bits
start_time: s, first sample of the frame
polarization: "scalar" (one coefficient a hit, TE or TM by the transmit polarisation; all antennas count as co-polarised),
"jones" (field vectors, co- and cross-polar echoes; 32 bytes a path more), or, unless given, "auto": field vectors where the
scene has coherent surfaces that are no flagged mirrors, rough ones that turn the polarisation, or antennas of several
polarisations; `paths.effects` tells which and why
footprint: filter of the ray's footprint on coherent echoes, "second_order", "first_order" or "none"; "edges" is a flatter
second order, for curved surfaces whose edges make the echo (a dish along its axis)
sampler: spreads the rays over the cone of each object, "lattice", "fibonacci", "r2" or "random"
batches: 1 to 64 independent lattices that share the rays, from which `received_power` tells standard errors; each is as
fine as its share of the rays; 1 unless given
target_error_db: dB; adds rays where they are missing, from num_rays (16 384 unless given) to at most max_rays, until the echo of
each object and image, down to 60 dB below the strongest, is known that well: half its 95 % interval (`received_power`). A
RuntimeWarning and `paths.frame.error_db` tell where max_rays did not do
progress: callable(stage, fraction) or None
kept: KeptGeometry, which ep.trace gives from a scene's second trace on: what has not moved since is not built again, for
about 200 bytes a triangle while the scene lives
Returns Paths. Raises ValueError for bad settings, mirrors that are not flat, motions that do not cover the frame.)");
}

}  // namespace echopath::bindings
