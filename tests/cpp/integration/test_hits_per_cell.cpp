// How many more hits cells of the map ask for: against cells counted by hand from where the hits lie.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <vector>

#include "cpp/support/scenes.h"
#include "echopath/motion/motion.h"
#include "echopath/power/path_power.h"
#include "echopath/radar/noise_power.h"
#include "echopath/sim/rays/hits_per_cell.h"
#include "echopath/sim/rays/trace_to_error.h"

namespace echopath::test_hits_per_cell {
namespace {

using namespace testing;

constexpr double kMost = 32.0;
const Vec3 kVelocity(-20.0, 3.0, 0.0);  // m/s

// A ground that passes by below the antenna, and a wall at rest.
Scene passing_ground() {
  Scene scene;
  add_rectangle(scene, "ground", {2, -20, -1}, {60, 0, 0}, {0, 40, 0}, lambert(0.3),
                std::make_shared<const LinearMotion>(kVelocity));
  add_rectangle(scene, "wall", {9, 5, 0}, {0, 1, 0}, {0, 0, 1}, lambert(0.3));
  return scene;
}

Radar radar_of(double power, size_t num_receivers = 1) {
  Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero(), 1.0, power);
  radar.waveform.num_chirps = 64;
  radar.receivers.resize(num_receivers, radar.receivers[0]);
  return radar;
}

// Where a hit of a path of one bounce lies at the time of the trace.
Vec3 place_of(const Paths& paths, int64_t path) {
  const Hit& hit = paths.hits_of(path)[0];
  const Mesh& mesh = *paths.scene->node_of(hit.mesh_id).mesh;
  const Triangle& triangle = mesh.triangles()[hit.triangle_id];
  const Vec3 &a = mesh.vertices()[triangle[0]], &b = mesh.vertices()[triangle[1]], &c = mesh.vertices()[triangle[2]];
  const Vec3 at_rest = a + double(hit.u) * (b - a) + double(hit.v) * (c - a);
  return hit.mesh_id == 0 ? at_rest + kVelocity * paths.frame.trace_time : at_rest;
}

double growth_by_hand(const Paths& paths, uint32_t mesh) {
  const ChirpSequence& waveform = paths.radar.waveform;
  std::map<std::pair<double, double>, std::vector<double>> cells;
  const std::vector<double> power = path_power(paths);
  for (int64_t path = 0; path < paths.num_paths(); ++path) {
    if (paths.hits_of(path)[0].mesh_id != mesh) continue;
    const Vec3 place = place_of(paths, path);
    const double velocity = mesh == 0 ? kVelocity.dot(place.normalized()) : 0.0;
    cells[{std::floor(place.norm() / waveform.range_resolution()), std::floor(velocity / waveform.velocity_resolution(1))}]
        .push_back(power[static_cast<size_t>(path)]);
  }
  const double noise = noise_power_in_cell(paths.radar) / static_cast<double>(paths.radar.receivers.size());
  double growth = 0.0, weights = 0.0;
  for (const auto& [cell, hits] : cells) {
    double sum = 0.0, squares = 0.0;
    for (const double one : hits) {
      sum += one;
      squares += one * one;
    }
    const double weight = sum / (noise + sum), of_a_hit = squares / sum;
    growth += weight * std::min(4.0 * of_a_hit / (noise + sum - of_a_hit), kMost);
    weights += weight;
  }
  return growth / weights;
}

// A faint ground, whose far cells are below the noise, one that asks for more rays everywhere, and a wall of few cells.
TEST(HitsPerCell, AskForRaysAsCellsCountedByHandDo) {
  for (const double power : {1e-3, 1.0, 1e3}) {
    const Paths paths = trace(passing_ground(), radar_of(power, power < 1.0 ? 3 : 1), with_rays(4000, 1));
    std::vector<uint32_t> group;
    for (int64_t path = 0; path < paths.num_paths(); ++path) group.push_back(paths.hits_of(path)[0].mesh_id);
    const std::vector<double> growth = growth_by_cells(paths, group, 3, path_power(paths), kMost, nullptr);
    // A hit or two of hundreds lie so near the border of a cell that rounding decides.
    EXPECT_NEAR(growth[0], growth_by_hand(paths, 0), 0.02 * growth[0]) << power;
    EXPECT_NEAR(growth[1], growth_by_hand(paths, 1), 0.02 * growth[1]) << power;
    EXPECT_EQ(growth[2], 0.0);
    EXPECT_GT(growth[0], power < 1.0 ? 0.0 : 4.0) << power;
    EXPECT_LT(growth[1], 1.0) << power;
  }
}

// Who names no number of rays asks for what stands above the noise of the map, and so for its cells.
TEST(HitsPerCell, AreServedByTracesToTheNoiseOfTheMapAlone) {
  ErrorTarget of_map, of_power;
  of_map.floor = EchoFloor::kNoise;
  of_map.error_db = of_power.error_db = 10.0;  // which the first trace meets
  const auto traced = [](const ErrorTarget& target) {
    return trace_to_error(SceneSnapshot(passing_ground()), radar_of(1e3), with_rays(4000, 1), target, nullptr, nullptr);
  };
  const auto num_on_ground = [](const Paths& paths) {
    int64_t count = 0;
    for (int64_t path = 0; path < paths.num_paths(); ++path) count += paths.hits_of(path)[0].mesh_id == 0;
    return count;
  };
  const Paths served = traced(of_map), known = traced(of_power);
  EXPECT_EQ(known.frame.statistics.num_rays, 4000);
  EXPECT_EQ(served.frame.statistics.num_rays, 8000);
  EXPECT_GT(num_on_ground(served), num_on_ground(known) * 3 / 2);
}

// The paths of a hit there and back arrive in phase, and are one.
TEST(HitsPerCell, CountBothWaysOfAPathAsOneHit) {
  Material mirror;
  mirror.reflectivity = 0.5;
  mirror.mirror = true;
  Scene scene;
  add_rectangle(scene, "floor", {-1, -20, -1}, {40, 0, 0}, {0, 40, 0}, share(mirror));
  add_rectangle(scene, "plate", {12, -1, -0.5}, {0, 2, 0}, {0, 0, 1}, lambert(0.3));
  const Paths paths = trace(scene, plain_radar(Vec3::Zero(), Vec3::Zero(), 1.0, 1e6), with_rays(2000, 2));
  std::vector<uint8_t> over_floor_once, one_way;
  for (int64_t path = 0; path < paths.num_paths(); ++path) {
    const bool is_one = paths.num_bounces[static_cast<size_t>(path)] == 2 && paths.diffuse[static_cast<size_t>(path)] != 0;
    over_floor_once.push_back(is_one);
    one_way.push_back(is_one && paths.hits_of(path)[0].mesh_id == 0);
  }
  const auto growth_of = [&](const std::vector<uint8_t>& keep) {
    const Paths some = paths.select(keep);
    const std::vector<uint32_t> group(static_cast<size_t>(some.num_paths()), 0);
    return std::pair(some.num_paths(), growth_by_cells(some, group, 1, path_power(some), kMost, nullptr)[0]);
  };
  const auto [num_both, of_both] = growth_of(over_floor_once);
  const auto [num_one, of_one] = growth_of(one_way);
  EXPECT_EQ(num_both, 2 * num_one);
  EXPECT_GT(num_one, 100);
  EXPECT_NEAR(of_both, of_one, 0.02 * of_one);  // far above the noise
}

}  // namespace
}  // namespace echopath::test_hits_per_cell
