#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <string>

#include "call/run_job.h"
#include "echopath/trace/live/live_trace.h"
#include "values/array.h"
#include "values/choice.h"

namespace echopath::bindings {
namespace {

using PathsPtr = std::shared_ptr<Paths>;

PathsPtr kept(Paths&& paths) { return std::make_shared<Paths>(std::move(paths)); }

py::dict update_live(LiveTrace& live, Scene scene, const Radar& radar, int64_t num_rays, int max_bounces, uint64_t seed,
                     double start_time, const std::string& polarization, const std::string& footprint,
                     const std::string& sampler, const std::string& scatterers, bool edges, double attenuation,
                     const py::object& progress) {
  TraceSettings settings;
  settings.num_rays = num_rays;
  settings.max_bounces = max_bounces;
  settings.seed = seed;
  settings.start_time = start_time;
  settings.polarization = kPolarization.value_of(polarization);
  settings.footprint = kFootprint.value_of(footprint);
  settings.sampler = kSampler.value_of(sampler);
  settings.scatterers = kScatterers.value_of(scatterers);
  settings.edges = edges;
  settings.attenuation = attenuation;
  const SceneSnapshot snapshot(std::move(scene));
  // What ends the job as it ends, such as an exception of `progress`, must leave the record that Python knows of.
  LiveTrace::Next next = run_job("trace", progress, [&](Job& job) { return live.prepare(snapshot, radar, settings, &job); });
  LiveTrace::Change change = live.accept(std::move(next));
  py::dict out;
  out["is_whole"] = change.is_whole;
  out["num_rays"] = change.num_rays;
  out["num_rays_shot"] = change.num_rays_shot;
  out["removed"] = kept(std::move(change.removed));
  out["added"] = kept(std::move(change.added));
  return out;
}

}  // namespace

void bind_live(py::module_& m) {
  py::class_<LiveTrace>(m, "LiveTrace",
                        "The record of a scene that is changed again and again, no part of the public interface.")
      .def(py::init([](bool whole_scenes) {
             return std::make_unique<LiveTrace>(whole_scenes ? LiveTrace::Scenes::kWhole : LiveTrace::Scenes::kOfWhatIsMet);
           }),
           py::arg("whole_scenes") = false)
      .def("update", &update_live, py::arg("scene"), py::arg("radar"), py::kw_only(), py::arg("num_rays"),
           py::arg("max_bounces"), py::arg("seed"), py::arg("start_time"), py::arg("polarization"), py::arg("footprint"),
           py::arg("sampler"), py::arg("scatterers"), py::arg("edges"), py::arg("attenuation"),
           py::arg("progress") = py::none(),
           "What ep.Live calls. Returns is_whole, num_rays_shot, and the Paths removed and added.")
      .def(
          "paths",
          [](const LiveTrace& live, const py::object& progress) {
            return run_job("trace", progress, [&](Job& job) { return kept(live.paths(&job)); });
          },
          py::arg("progress") = py::none(), "The whole record, Paths.");
}

}  // namespace echopath::bindings
