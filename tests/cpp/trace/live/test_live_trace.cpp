// A live trace has the record of a fresh trace after every change, to the bit, and tells what differs.
#include <gtest/gtest.h>

#include <bit>
#include <functional>
#include <map>
#include <random>

#include "cpp/support/sanitized.h"
#include "cpp/support/scenes.h"
#include "echopath/trace/live/live_trace.h"

namespace echopath::test_live_trace {
namespace {

using namespace testing;

constexpr int kNumObjects = 8;

MaterialPtr rough_metal() {
  Material material = Material::metal();
  material.scattering = 0.4;
  return share(material);
}

Node ball(const std::string& name, const Vec3& place, bool smooth) {
  static const Surface surface = ellipsoid(Vec3::Zero(), {0.7, 0.5, 0.6}, 2);
  Node node = node_with(name, surface, smooth ? share(Material::metal()) : lambert(0.7), smooth);
  node.placement = Transform(Eigen::Translation3d(place));
  return node;
}

// A street with a ground and a wall, flagged mirrors or plain, and eight bodies of which one moves.
Scene street(bool mirrors) {
  Scene scene;
  Material road;
  road.permittivity = {5.0, -0.3};
  road.scattering = 0.3;
  road.mirror = mirrors;
  add_rectangle(scene, "ground", {-2, -8, -1}, {40, 0, 0}, {0, 16, 0}, share(road));
  add_rectangle(scene, "wall", {-2, 8, -1}, {40, 0, 0}, {0, 0, 6}, share(road));
  for (int k = 0; k < kNumObjects; ++k) {
    Node node = ball("ball_" + std::to_string(k), {6.0 + 3.0 * k, k % 2 ? 3.0 : -2.0, 0.2}, k % 3 == 0);
    if (k == 1) node.motion = std::make_shared<LinearMotion>(Vec3(5, 0, 0), Vec3::Zero());
    scene.add(node);
  }
  return scene;
}

TraceSettings settings_with(Scatterers scatterers = Scatterers::kRays, int64_t num_rays = 3000) {
  TraceSettings settings = with_rays(num_rays);
  settings.scatterers = scatterers;
  settings.for_edits = true;
  return settings;
}

Radar radar() { return plain_radar({0, 0, 0.3}, {0, 0.1, 0.3}); }

using Row = std::vector<uint64_t>;

// Everything about a path, with names for its meshes and its stratum, which have numbers of their own in each scene.
Row row_of(const Paths& paths, size_t path, bool by_name) {
  const uint16_t own = paths.stratum[path];
  const std::hash<std::string> number;
  const uint64_t stratum = by_name && own != kNoStratum ? number(paths.frame.strata[own].name) : own;
  Row row{paths.num_bounces[path],
          paths.diffuse[path],
          stratum,
          paths.batch[path],
          paths.flags[path],
          std::bit_cast<uint32_t>(paths.weight[path].real()),
          std::bit_cast<uint32_t>(paths.weight[path].imag())};
  const Hit* hits = paths.hits_of(static_cast<int64_t>(path));
  for (int k = 0; k < paths.num_bounces[path]; ++k) {
    const uint64_t mesh = by_name ? number(paths.scene->node_of(hits[k].mesh_id).name) : hits[k].mesh_id;
    row.insert(row.end(),
               {mesh, hits[k].triangle_id, std::bit_cast<uint32_t>(hits[k].u), std::bit_cast<uint32_t>(hits[k].v)});
  }
  const std::array<float, 7> flat{};  // an empty column stands for zeros
  for (const float value : paths.curved_cell.empty() ? flat : paths.curved_cell[path])
    row.push_back(std::bit_cast<uint32_t>(value));
  return row;
}

std::vector<Row> rows_of(const Paths& paths, bool by_name = false) {
  std::vector<Row> rows;
  for (size_t path = 0; path < static_cast<size_t>(paths.num_paths()); ++path) rows.push_back(row_of(paths, path, by_name));
  return rows;
}

// The paths without their order, as counts.
std::map<Row, int> counts_of(const Paths& paths) {
  std::map<Row, int> counts;
  for (const Row& row : rows_of(paths, true)) ++counts[row];
  return counts;
}

// Changes one thing of a scene at random.
void change(Scene& scene, std::mt19937_64& draw) {
  const auto pick = [&](int count) { return std::uniform_int_distribution<int>(0, count - 1)(draw); };
  std::uniform_real_distribution<double> step(-0.6, 0.6);
  const int index = 2 + pick(static_cast<int>(scene.nodes().size()) - 2);
  Node node = scene.nodes()[static_cast<size_t>(index)];
  switch (pick(10)) {
    case 8: return scene.remove(index);
    case 9: {
      Node guest = ball("guest_" + std::to_string(draw()), {8.0 + step(draw), 5.0, 0.2}, pick(2) == 0);
      scene.add(guest);
      return;
    }

    case 0: node.material = node.smooth ? rough_metal() : lambert(0.3); break;
    case 1: node.motion = std::make_shared<LinearMotion>(Vec3(step(draw), step(draw), 0), Vec3(0, 0, step(draw))); break;
    case 2: node.visible = !node.visible; break;
    case 3: node.placement = node.placement * Eigen::AngleAxisd(step(draw), Vec3::UnitZ()); break;
    default: node.placement.translation() += Vec3(step(draw), step(draw), 0.2 * step(draw)); break;
  }
  scene.change(index, node);
}

void expect_as_fresh(bool mirrors, Scatterers scatterers, int num_changes, uint64_t seed) {
  Scene scene = street(mirrors);
  const TraceSettings settings = settings_with(scatterers);
  std::mt19937_64 draw(seed);
  LiveTrace live;
  live.update(scene, radar(), settings);
  int64_t num_shot = 0;
  for (int k = 0; k < num_changes; ++k) {
    change(scene, draw);
    num_shot += live.update(scene, radar(), settings).num_rays_shot;
    ASSERT_EQ(rows_of(live.paths()), rows_of(trace(scene, radar(), settings))) << "change " << k << ", seed " << seed;
  }
  EXPECT_LT(num_shot, num_changes * settings.num_rays);
}

TEST(LiveTrace, HasTheRecordOfAFreshTraceAfterEveryChange) {
  const int num_changes = test::kIsSanitized ? 5 : 15;
  expect_as_fresh(false, Scatterers::kRays, num_changes, 1);
  expect_as_fresh(true, Scatterers::kRays, num_changes, 2);
  expect_as_fresh(false, Scatterers::kSurface, num_changes, 3);
}

TEST(LiveTrace, ShootsNothingWhereNothingChanges) {
  LiveTrace live;
  const Scene scene = street(true);
  const LiveTrace::Change first = live.update(scene, radar(), settings_with());
  EXPECT_EQ(first.num_rays_shot, first.num_rays);
  const LiveTrace::Change change = live.update(scene, radar(), settings_with());
  EXPECT_EQ(change.num_rays_shot, 0);
  EXPECT_FALSE(change.is_whole);
  EXPECT_EQ(change.added.num_paths(), 0);
  EXPECT_EQ(change.removed.num_paths(), 0);
}

// A body behind all others, which only few rays pass.
TEST(LiveTrace, ShootsFewRaysForABodyOutOfTheWay) {
  Scene scene = street(false);
  LiveTrace live;
  live.update(scene, radar(), settings_with());
  Node node = scene.nodes().back();
  node.placement.translation() += Vec3(0.1, 0, 0);
  scene.change(static_cast<int>(scene.nodes().size()) - 1, node);
  EXPECT_LT(live.update(scene, radar(), settings_with()).num_rays_shot, 1200);
}

// Each edit concerns one object of eight, whether or not it comes, goes or begins to move, or is the farthest of all.
TEST(LiveTrace, LeavesMostRaysOfOtherObjectsWhatTheyAre) {
  using Edit = std::function<void(Scene&)>;
  const auto changed = [](const std::function<void(Node&)>& how) {
    return [how](Scene& scene) {
      const int index = *scene.find("ball_5");
      Node node = scene.nodes()[static_cast<size_t>(index)];
      how(node);
      scene.change(index, node);
    };
  };
  const std::vector<std::pair<std::string, Edit>> edits = {
      {"hides", changed([](Node& node) { node.visible = false; })},
      {"appears", changed([](Node& node) { node.visible = true; })},
      {"begins to move",
       changed([](Node& node) { node.motion = std::make_shared<LinearMotion>(Vec3(3, 0, 0), Vec3::Zero()); })},
      {"rests", changed([](Node& node) { node.motion = nullptr; })},
      {"is the farthest", changed([](Node& node) { node.placement.translation() = Vec3(45, 1, 0.2); })},
      {"is farther", changed([](Node& node) { node.placement.translation() += Vec3(0.5, 0, 0); })},
      {"goes", [](Scene& scene) { scene.remove(*scene.find("ball_5")); }},
      {"comes", [](Scene& scene) { scene.add(ball("guest", {14, 4, 0.2}, true)); }}};
  for (const bool mirrors : {false, true}) {
    Scene scene = street(mirrors);
    LiveTrace live;
    live.update(scene, radar(), settings_with());
    for (const auto& [name, edit] : edits) {
      edit(scene);
      const LiveTrace::Change change = live.update(scene, radar(), settings_with());
      EXPECT_LT(change.num_rays_shot, 0.6 * static_cast<double>(change.num_rays)) << name << ", mirrors " << mirrors;
      EXPECT_EQ(rows_of(live.paths()), rows_of(trace(scene, radar(), settings_with()))) << name << ", mirrors " << mirrors;
    }
  }
}

TEST(LiveTrace, WhatIsRemovedAndAddedMakesTheOneRecordTheOther) {
  Scene scene = street(true);
  const TraceSettings settings = settings_with();
  LiveTrace live;
  Paths before = live.update(scene, radar(), settings).added;
  std::mt19937_64 draw(4);
  int num_compared = 0;
  for (int k = 0; k < (test::kIsSanitized ? 7 : 20); ++k) {
    change(scene, draw);
    const LiveTrace::Change change = live.update(scene, radar(), settings);
    const Paths after = live.paths();
    if (!change.is_whole) {
      std::map<Row, int> counts = counts_of(before);
      for (const auto& [row, count] : counts_of(change.removed)) counts[row] -= count;
      for (const auto& [row, count] : counts_of(change.added)) counts[row] += count;
      std::erase_if(counts, [](const auto& entry) { return entry.second == 0; });
      EXPECT_EQ(counts, counts_of(after)) << k;
      EXPECT_LT(change.added.num_paths(), after.num_paths());
      ++num_compared;
    }
    before = after;
  }
  EXPECT_GT(num_compared, test::kIsSanitized ? 2 : 5);
}

TEST(LiveTrace, AnOtherRadarOrOtherSettingsAreFollowed) {
  const Scene scene = street(true);
  LiveTrace live;
  live.update(scene, radar(), settings_with());
  const Radar other = plain_radar({0.5, 0, 0.4}, {0.5, 0.1, 0.4});
  live.update(scene, other, settings_with());
  EXPECT_EQ(rows_of(live.paths()), rows_of(trace(scene, other, settings_with())));
  live.update(scene, other, settings_with(Scatterers::kRays, 1000));
  EXPECT_EQ(rows_of(live.paths()), rows_of(trace(scene, other, settings_with(Scatterers::kRays, 1000))));
  TraceSettings jones = settings_with();
  jones.polarization = PolarizationModel::kJones;
  live.update(scene, other, jones);
  EXPECT_EQ(live.paths().jones, trace(scene, other, jones).jones);
}

// More chirps at the same rays: the middle of the frame comes later, and only what moves is elsewhere then.
TEST(LiveTrace, AnOtherWaveformShootsOnlyWhatSeesTheSceneMoved) {
  Scene scene = street(false);
  LiveTrace live;
  live.update(scene, radar(), settings_with());
  Radar longer = radar();
  longer.waveform.num_chirps = 3;
  const int64_t num_shot = live.update(scene, longer, settings_with()).num_rays_shot;
  EXPECT_GT(num_shot, 0);
  EXPECT_LT(num_shot, 2500);
  EXPECT_EQ(rows_of(live.paths()), rows_of(trace(scene, longer, settings_with())));
}

TEST(LiveTrace, KeepsItsRecordWhereAnUpdateFails) {
  Scene scene = street(true);
  LiveTrace live;
  EXPECT_THROW(live.paths(), std::invalid_argument);
  live.update(scene, radar(), settings_with());
  const std::vector<Row> before = rows_of(live.paths());
  Node node = scene.nodes().back();
  node.placement.translation() += Vec3(0.5, 0, 0);
  scene.change(static_cast<int>(scene.nodes().size()) - 1, node);
  Job job;
  job.cancel();
  EXPECT_THROW(live.update(scene, radar(), settings_with(), &job), Cancelled);
  EXPECT_THROW(live.update(scene, radar(), settings_with(Scatterers::kRays, 0)), std::invalid_argument);
  EXPECT_EQ(rows_of(live.paths()), before);
  live.update(scene, radar(), settings_with());
  EXPECT_EQ(rows_of(live.paths()), rows_of(trace(scene, radar(), settings_with())));
}

TEST(LiveTrace, AnEmptySceneHasNoPaths) {
  LiveTrace live;
  EXPECT_EQ(live.update(Scene(), radar(), settings_with()).added.num_paths(), 0);
  live.update(street(true), radar(), settings_with());
  EXPECT_EQ(rows_of(live.paths()), rows_of(trace(street(true), radar(), settings_with())));
}

}  // namespace
}  // namespace echopath::test_live_trace
