#include <pybind11/pybind11.h>

#include <limits>
#include <vector>

#include "array.h"
#include "echopath/base/errors.h"
#include "echopath/base/parallel.h"
#include "echopath/trace/geometry/embree_scene.h"
#include "run_job.h"

namespace echopath::bindings {
namespace {

constexpr uint32_t kNoMesh = std::numeric_limits<uint32_t>::max();
constexpr int64_t kRaysPerBlock = 4096;

struct FirstHits {
  explicit FirstHits(size_t count) : mesh_id(count, kNoMesh), triangle_id(count, 0), distance(count), is_false(count, 0) {}
  std::vector<uint32_t> mesh_id, triangle_id;
  std::vector<double> distance;
  std::vector<uint8_t> is_false;
};

template <class Query>
void for_each_ray(size_t count, Job& job, const Query& query) {
  const auto num_rays = static_cast<int64_t>(count);
  parallel_for((num_rays + kRaysPerBlock - 1) / kRaysPerBlock, [&](int64_t block) {
    const int64_t end = std::min((block + 1) * kRaysPerBlock, num_rays);
    for (int64_t i = block * kRaysPerBlock; i < end; ++i) query(static_cast<size_t>(i));
  }, &job);
}

FirstHits find_first_hits(const Scene& scene, double time, const Vec3& near, const std::vector<Vec3>& origins,
                          const std::vector<Vec3>& directions, Job& job) {
  const PosedScene pose(scene, time);
  const Vec3 origin = EmbreeScene::origin_near(scene, pose, near);
  const EmbreeScene geometry(scene, pose, origin, &job);
  FirstHits found(origins.size());
  for_each_ray(origins.size(), job, [&](size_t i) {
    RayHit hit;
    const EmbreeScene::Verdict verdict = geometry.intersect(origins[i] - origin, directions[i].normalized(), hit);
    found.is_false[i] = verdict == EmbreeScene::Verdict::kFalseHit;
    if (verdict != EmbreeScene::Verdict::kHit) return;
    found.mesh_id[i] = hit.hit.mesh_id;
    found.triangle_id[i] = hit.hit.triangle_id;
    found.distance[i] = hit.distance;
  });
  return found;
}

py::tuple first_hits(Scene scene, const py::object& origins, const py::object& directions, double time) {
  const std::vector<Vec3> from = as_points(origins, "origins"), along = as_points(directions, "directions");
  require(from.size() == along.size(), "directions", "must be as many as origins, rows", along.size());
  const Vec3 near = from.empty() ? Vec3(Vec3::Zero()) : from.front();
  FirstHits found = run_job("first_hits", py::none(),
                            [&](Job& job) { return find_first_hits(scene, time, near, from, along, job); });
  return py::make_tuple(numpy_take(std::move(found.mesh_id)), numpy_take(std::move(found.triangle_id)),
                        numpy_take(std::move(found.distance)), numpy_take(std::move(found.is_false)));
}

py::array blocked(Scene scene, const py::object& starts, const py::object& ends, double time) {
  const std::vector<Vec3> from = as_points(starts, "starts"), to = as_points(ends, "ends");
  require(from.size() == to.size(), "ends", "must be as many as starts, rows", to.size());
  const Vec3 near = from.empty() ? Vec3(Vec3::Zero()) : from.front();
  return numpy_take(run_job("blocked", py::none(), [&](Job& job) {
    const PosedScene pose(scene, time);
    const Vec3 origin = EmbreeScene::origin_near(scene, pose, near);
    const EmbreeScene geometry(scene, pose, origin, &job);
    std::vector<uint8_t> out(from.size());
    for_each_ray(from.size(), job, [&](size_t i) { out[i] = geometry.occluded(from[i] - origin, to[i] - origin); });
    return out;
  }));
}

}  // namespace

void bind_first_hits(py::module_& m) {
  m.def("first_hits", &first_hits, py::arg("scene"), py::arg("origins"), py::arg("directions"), py::kw_only(),
        py::arg("time") = 0.0,
        R"(What rays meet first, as the trace sees it: for tests against other ray tracers.

origins: [N, 3] in m, world; directions: [N, 3], any length; time: s
Returns (mesh_id [N], 2^32 - 1 for none; triangle_id [N]; distance [N] in m; is_false [N], 1: found, but not confirmed in
double precision). Raises ValueError naming the argument.)");
  m.def("blocked", &blocked, py::arg("scene"), py::arg("starts"), py::arg("ends"), py::kw_only(), py::arg("time") = 0.0,
        R"(Whether something lies on the open segments between points, as the trace sees it: for tests.

starts, ends: [N, 3] in m, world; time: s
Returns [N], 1: blocked. Raises ValueError naming the argument.)");
}

}  // namespace echopath::bindings
