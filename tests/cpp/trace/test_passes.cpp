// The sheets through which paths go, against a loop over all triangles.
#include <gtest/gtest.h>

#include "cpp/support/scenes.h"
#include "echopath/trace/sheets/passes.h"

namespace echopath::test_passes {
namespace {

using namespace testing;

MaterialPtr pane() {
  Material material;
  material.layers = {{0.004, {6.0, 0.0}}};
  return share(material);
}

// Some rough squares, and slanted panes of two triangles that stand between them and the radar at random.
Scene scene_of(int num_panes) {
  Scene scene;
  for (int i = 0; i < 4; ++i)
    add_rectangle(scene, "target" + std::to_string(i), Vec3(20.0, 3.0 * i - 6.0, -1.0), {0, 2, 0}, {0, 0, 2}, lambert(0.5));
  for (int i = 0; i < num_panes; ++i) {
    const double y = std::fmod(2.39 * i, 9.0) - 6.0;
    add_rectangle(scene, "pane" + std::to_string(i), Vec3(4.0 + 14.0 * i / num_panes, y, -3.0), {0.7, 3.0, 0.2},
                  {0.3, -0.2, 6.0}, pane());
  }
  return scene;
}

Paths traced(const Scene& scene, int max_bounces = 1) {
  return trace(scene, plain_radar(Vec3::Zero(), Vec3(0, 0.01, 0)), with_rays(400, max_bounces));
}

// Whether a path is an echo of a target, not of a pane.
bool is_of_target(const Paths& paths, int64_t path) {
  return !paths.scene->node_of(paths.hits_of(path)->mesh_id).material->is_sheet();
}

// Whether an open segment crosses a triangle (signed volumes).
bool crosses(const Vec3& from, const Vec3& to, const std::array<Vec3, 3>& corners) {
  const auto side = [&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return (b - a).cross(c - a).dot(d - a);
  };
  const auto& [a, b, c] = corners;
  if (side(a, b, c, from) * side(a, b, c, to) >= 0) return false;
  const double u = side(from, to, a, b), v = side(from, to, b, c), w = side(from, to, c, a);
  return (u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0);
}

// By leg, the sheets that a path crosses.
std::vector<std::pair<uint32_t, uint32_t>> slow_passes(const Paths& paths, int64_t path) {
  const PosedScene pose(*paths.scene, paths.frame.trace_time);
  std::vector<Vec3> points = {paths.frame.transmitter};
  for (int k = 0; k < paths.num_bounces[static_cast<size_t>(path)]; ++k) {
    const Hit& hit = paths.hits_of(path)[k];
    const auto [a, b, c] = pose.world_triangle(hit.mesh_id, hit.triangle_id);
    points.push_back(a + double{hit.u} * (b - a) + double{hit.v} * (c - a));
  }
  points.push_back(paths.frame.receiver);
  std::vector<std::pair<uint32_t, uint32_t>> found;
  for (uint32_t leg = 0; leg + 1 < points.size(); ++leg) {
    for (uint32_t id = 0; id < paths.scene->meshes().size(); ++id) {
      if (!paths.scene->node_of(id).material->is_sheet()) continue;
      for (uint32_t triangle = 0; triangle < 2; ++triangle) {
        if (crosses(points[leg], points[leg + 1], pose.world_triangle(id, triangle))) found.emplace_back(leg, id);
      }
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

TEST(Passes, AreThoseOfALoopOverAllTriangles) {
  const Paths paths = traced(scene_of(12));
  ASSERT_GT(paths.num_paths(), 100);
  size_t total = 0;
  for (int64_t path = 0; path < paths.num_paths(); ++path) {
    if (!is_of_target(paths, path)) continue;
    std::vector<std::pair<uint32_t, uint32_t>> found;
    for (const Pass& pass : paths.passes_of(static_cast<size_t>(path))) found.emplace_back(pass.leg, pass.hit.mesh_id);
    EXPECT_TRUE(std::is_sorted(found.begin(), found.end(), [](auto a, auto b) { return a.first < b.first; }));
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, slow_passes(paths, path)) << path;
    total += found.size();
  }
  EXPECT_GT(total, 400u);
}

TEST(Passes, StandInTheOrderOfTravel) {
  const Paths paths = traced(scene_of(12));
  const PosedScene pose(*paths.scene, paths.frame.trace_time);
  for (int64_t path = 0; path < paths.num_paths(); ++path) {
    double before = 0.0;
    for (const Pass& pass : paths.passes_of(static_cast<size_t>(path))) {
      if (pass.leg != 0) break;
      const auto [a, b, c] = pose.world_triangle(pass.hit.mesh_id, pass.hit.triangle_id);
      const double at = (a + double{pass.hit.u} * (b - a) + double{pass.hit.v} * (c - a)).norm();
      EXPECT_GT(at, before);
      before = at;
    }
  }
}

TEST(Passes, ARecordWithoutSheetsHasNone) {
  const Paths paths = traced(scene_of(0));
  EXPECT_TRUE(paths.passes.empty());
  EXPECT_TRUE(paths.pass_offsets.empty());
}

TEST(Passes, ALegThroughMoreThanTheMostIsStoppedAndCounted) {
  Scene scene;
  add_rectangle(scene, "target", {20, -1, -1}, {0, 2, 0}, {0, 0, 2}, lambert(0.5));
  for (int i = 0; i <= kMostPasses; ++i)
    add_rectangle(scene, "pane" + std::to_string(i), Vec3(5.0 + 0.1 * i, -5, -5), {0, 10, 0}, {0, 0, 10}, pane());
  const Paths paths = traced(scene);
  int64_t num_stopped = 0;
  for (int64_t path = 0; path < paths.num_paths(); ++path) {
    if (!is_of_target(paths, path)) continue;
    ++num_stopped;
    EXPECT_EQ(std::abs(paths.weight[static_cast<size_t>(path)]), 0.0f);
  }
  EXPECT_GT(num_stopped, 0);
  EXPECT_GE(paths.frame.statistics.num_stopped_passes, num_stopped);
}

}  // namespace
}  // namespace echopath::test_passes
