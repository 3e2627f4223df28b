#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "call/argument.h"
#include "call/leaving.h"
#include "call/run_job.h"
#include "echopath/sim/rays/ray_allocation.h"
#include "echopath/trace/edges/around_edges.h"
#include "echopath/trace/edges/edge_power.h"
#include "echopath/trace/embree/embree_scene.h"
#include "echopath/trace/embree/kept_geometry.h"
#include "echopath/trace/trace.h"
#include "paths/error_target.h"
#include "paths/record_keywords.h"
#include "scene/scene_geometry.h"
#include "values/array.h"

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

PathsPtr trace_paths(Scene scene, const Radar& radar, const RecordSettings& of_record, std::optional<int64_t> num_rays,
                     double start_time, std::optional<double> target_error_db, int64_t max_rays, const py::object& progress,
                     const std::shared_ptr<KeptGeometry>& kept, const std::shared_ptr<KeptStillRays>& kept_still,
                     std::optional<double> objects_time) {
  const Effort effort = effort_of(num_rays, of_record.batches, target_error_db, max_rays);
  TraceSettings settings{of_record};
  settings.num_rays = effort.num_rays;
  settings.start_time = start_time;
  settings.batches = effort.batches;
  const SceneSnapshot snapshot(std::move(scene));
  auto paths = std::make_shared<Paths>(run_job("trace", progress, [&](Job& job) {
    return effort.target ? trace_to_error(snapshot, radar, settings, *effort.target, &job, kept.get(), kept_still.get())
                         : trace_by_need(snapshot, radar, settings, &job, kept.get(), kept_still.get());
  }));
  if (kept) remember_geometry(paths->scene, kept);
  paths->frame.objects_time = objects_time;
  const TraceFrame& frame = paths->frame;
  if (target_error_db && frame.error_db > frame.target_error_db) {
    warn_of_missed_target("trace: max_rays", frame.error_db, frame.target_error_db);
  }
  return paths;
}

template <class... Keywords>
void bind_trace_paths(py::module_& m, ListOfKeywords<RecordSettings, Keywords...> of_record) {
  m.def(
      "trace",
      [](Scene scene, const Radar& radar, std::optional<int64_t> num_rays, double start_time,
         std::optional<double> target_error_db, int64_t max_rays, const py::object& progress,
         const std::shared_ptr<KeptGeometry>& kept, const std::shared_ptr<KeptStillRays>& kept_still,
         std::optional<double> objects_time, const typename Keywords::Argument&... settings) {
        return trace_paths(std::move(scene), radar, decltype(of_record)::made_of(settings...), num_rays, start_time,
                           target_error_db, max_rays, progress, kept, kept_still, objects_time);
      },
      py::arg("scene"), py::arg("radar"), py::kw_only(), py::arg("num_rays") = py::none(), py::arg("start_time") = 0.0,
      py::arg("target_error_db") = py::none(), py::arg("max_rays") = kMaxRays, py::arg("progress") = py::none(),
      py::arg("kept") = py::none(), py::arg("kept_still") = py::none(), py::arg("objects_time") = py::none(),
      Keywords::argument()...,
      "What ep.trace calls. kept: KeptGeometry of the scene, or None; kept_still: KeptStillRays of the scene, radar and "
      "settings, whatever the start, or None; objects_time: s, as of TraceFrame.");
  py::dict defaults;
  ((defaults[Keywords::name()] = Keywords::value(RecordSettings{})), ...);
  m.attr("RECORD_SETTINGS") = defaults;  // by keyword, as TraceFrame has them too
}

py::array_t<bool> are_clear(Scene scene, double time, const Vec3& from, const std::vector<Vec3>& points) {
  std::vector<uint8_t> blocked(points.size(), 0);
  if (scene.num_triangles() > 0 && !points.empty()) {
    const WithoutGil released;
    const PosedScene pose(scene, time);
    const EmbreeScene geometry(scene, pose, EmbreeScene::origin_near(scene, pose, from));
    std::vector<Segment> segments;
    segments.reserve(points.size());
    for (const Vec3& point : points) segments.push_back({from - geometry.origin(), point - geometry.origin()});
    geometry.occluded(segments.data(), segments.size(), blocked.data());
  }
  py::array_t<bool> clear(std::ssize(points));
  for (size_t i = 0; i < points.size(); ++i) clear.mutable_data()[i] = !blocked[i];
  return clear;
}

py::dict around_edges(const AroundQuery& query, const std::vector<Vec3>& points, const py::object& progress) {
  const auto legs = run_job("legs around edges", progress, [&](Job& job) { return legs_around_edges(query, points, &job); });
  std::vector<uint32_t> mesh_id;
  std::vector<Vec3> point;
  std::vector<double> length, share;
  for (const LegAroundEdge& leg : legs) {
    mesh_id.push_back(leg.mesh_id);
    point.push_back(leg.point);
    length.push_back(leg.length);
    share.push_back(leg.share);
  }
  return py::dict(py::arg("mesh_id") = to_numpy(mesh_id), py::arg("point") = to_numpy(point),
                  py::arg("length") = to_numpy(length), py::arg("share") = to_numpy(share));
}

}  // namespace

void bind_trace(py::module_& m) {
  py::class_<KeptGeometry, std::shared_ptr<KeptGeometry>>(
      m, "KeptGeometry", "Geometry that goes from one trace of a scene to the next, no part of the public interface.")
      .def(py::init<>());
  py::class_<KeptStillRays, std::shared_ptr<KeptStillRays>>(
      m, "KeptStillRays", "Rays of what stands still, for all frames of a scene, no part of the public interface.")
      .def(py::init<>())
      .def(
          "__reduce__", [](const py::object& self) { return py::make_tuple(py::type::of(self), py::tuple()); },
          "A copy keeps none yet: what it keeps is the same.");

  bind_trace_paths(m, RecordKeywords{});
  m.def(
      "are_clear",
      [](Scene scene, Arg<"time", Real> time, Arg<"origin", Vector3> origin, Arg<"points", Points> points) {
        return are_clear(std::move(scene), *time, *origin, *points);
      },
      py::arg("scene"), py::arg("time"), py::arg("origin"), py::arg("points"),
      "Whether nothing of the scene lies between `origin` [3] and each of `points` [N, 3], m at `time` in s; [N].");
  m.def(
      "legs_around_edges",
      [](Scene scene, Arg<"time", Real> time, Arg<"frequency", Real> frequency, Arg<"antenna", Vector3> antenna,
         Arg<"polarization", Vector3> polarization, Arg<"points", Points> points, Arg<"edges", Flag> edges,
         const py::object& progress) {
        return around_edges({scene, *time, *frequency, *antenna, *polarization, *edges}, *points, progress);
      },
      py::arg("scene"), py::arg("time"), py::arg("frequency"), py::arg("antenna"), py::arg("polarization"),
      py::arg("points"), py::arg("edges") = true, py::arg("progress") = py::none(),
      R"(The strongest leg around one edge from an antenna to each of some points, and what all such legs bring there.

time: s; frequency: Hz; antenna: [3], m, world; polarization: [3], unit vector, world; points: [N, 3], m, world
edges: whether legs around edges are looked for, or only whether the points are seen
Returns a dict of mesh_id [N] (of the edge; 4294967295: none, or nothing in the way), point [N, 3] on it in m, length [N] in
m, share [N] of the field that would arrive were nothing in its way, around all edges together.)");
  m.def("strongest_edge", &strongest_edge, py::arg("scene"), py::arg("radar"), py::arg("time"),
        "What edges=\"auto\" compares with the noise: W that the strongest sharp edge would carry at a time in s.");
  m.attr("DEFAULT_MAX_RAYS") = kMaxRays;
  m.attr("MOST_RAYS") = kMostRays;
}

}  // namespace echopath::bindings
