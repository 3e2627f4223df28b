#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <utility>

#include "call/run_job.h"
#include "echopath/power/faint_paths.h"
#include "echopath/trace/live/live_trace.h"
#include "paths/record_keywords.h"

namespace echopath::bindings {
namespace {

using PathsPtr = std::shared_ptr<Paths>;

PathsPtr kept(Paths&& paths) { return std::make_shared<Paths>(std::move(paths)); }

py::dict update_live(LiveTrace& live, Scene scene, const Radar& radar, const RecordSettings& of_record, int64_t num_rays,
                     double start_time, const py::object& progress) {
  TraceSettings settings{of_record};
  settings.num_rays = num_rays;
  settings.start_time = start_time;
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

template <class... Keywords>
void bind_update(py::class_<LiveTrace>& bound, ListOfKeywords<RecordSettings, Keywords...> of_record) {
  bound.def(
      "update",
      [](LiveTrace& live, Scene scene, const Radar& radar, int64_t num_rays, double start_time, const py::object& progress,
         const typename Keywords::Argument&... settings) {
        return update_live(live, std::move(scene), radar, decltype(of_record)::made_of(settings...), num_rays, start_time,
                           progress);
      },
      py::arg("scene"), py::arg("radar"), py::kw_only(), py::arg("num_rays"), py::arg("start_time"),
      py::arg("progress") = py::none(), Keywords::argument()...,
      "What ep.Live calls. Returns is_whole, num_rays_shot, and the Paths removed and added.");
}

}  // namespace

void bind_live(py::module_& m) {
  py::class_<LiveTrace> bound(m, "LiveTrace",
                              "The record of a scene that is changed again and again, no part of the public interface.");
  bound
      .def(py::init([](bool whole_scenes) {
             return std::make_unique<LiveTrace>(whole_scenes ? LiveTrace::Scenes::kWhole : LiveTrace::Scenes::kOfWhatIsMet,
                                                thinned);
           }),
           py::arg("whole_scenes") = false)
      .def(
          "paths",
          [](const LiveTrace& live, const py::object& progress) {
            return run_job("trace", progress, [&](Job& job) { return kept(live.paths(&job)); });
          },
          py::arg("progress") = py::none(), "The whole record, Paths.");
  bind_update(bound, RecordKeywords{});
}

}  // namespace echopath::bindings
