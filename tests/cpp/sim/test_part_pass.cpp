#include <gtest/gtest.h>

#include "cpp/sim/slow_map.h"
#include "cpp/support/any_threads.h"
#include "cpp/support/path_by_path.h"
#include "cpp/support/scenes.h"
#include "cpp/support/waveforms.h"
#include "echopath/base/constants.h"
#include "echopath/sim/stream/part_pass.h"
#include "echopath/trace/trace.h"

namespace echopath::test_part_pass {
namespace {

using namespace testing;

constexpr double kSignal = 1e-6;  // of the largest cell: synthesis has a tolerance of 1e-7 of the sum of amplitudes
constexpr double kSums = 1e-12;   // relative to the largest sample
constexpr double kMoment = 1e-7;  // s, over which lengths are taken as linear

Radar radar_of() {
  Radar radar = plain_radar(Vec3::Zero(), {0, 0.02, 0});
  radar.waveform = small_waveform(5e8, 5e6, 16, 8);
  radar.receivers.push_back(antenna_at({0, 0.04, 0}));
  return radar;
}

Paths paths_of(const Radar& radar) {
  Scene scene;
  add_rectangle(scene, "wall", {4, -0.5, -0.5}, {0, 1, 0}, {0, 0, 1}, lambert(0.5));
  Node car = scene.nodes().front();
  car.name = "car";
  car.placement = Transform(Eigen::Translation3d(-1.5, 0.7, 0.0));
  car.motion = std::make_shared<LinearMotion>(Vec3(-20.0, 0.0, 0.0));
  scene.add(std::move(car));
  return trace(scene, radar, with_rays(120, 2));
}

std::vector<uint32_t> every_third(const Paths& paths) {
  std::vector<uint32_t> group;
  for (int64_t path = 0; path < paths.num_paths(); ++path) group.push_back(static_cast<uint32_t>(path % 3));
  return group;
}

// Samples [chirp, sample] of the paths of some groups in one channel, path by path.
std::vector<std::complex<double>> slow_samples(const Paths& paths, const Radar& radar, int channel,
                                               const std::vector<uint32_t>& group, const std::vector<uint32_t>& set) {
  const ChirpSequence& waveform = radar.waveform;
  std::vector<std::complex<double>> samples(static_cast<size_t>(waveform.num_chirps * waveform.num_samples));
  for (int chirp = 0; chirp < waveform.num_chirps; ++chirp) {
    const double time = radar.chirp_time(0, chirp);
    const PathByPath at(paths, radar, time), before(paths, radar, time - kMoment), after(paths, radar, time + kMoment);
    for (int64_t path = 0; path < paths.num_paths(); ++path) {
      if (std::find(set.begin(), set.end(), group[static_cast<size_t>(path)]) == set.end()) continue;
      const auto k = static_cast<size_t>(channel);
      const PathValue value = at(path)[k];
      const double rate = (after(path)[k].length - before(path)[k].length) / (2.0 * kMoment * kSpeedOfLight);
      add_samples(waveform, {value.length / kSpeedOfLight, rate, value.amplitude},
                  samples.data() + chirp * waveform.num_samples);
    }
  }
  return samples;
}

// The first group stands still.
std::vector<uint32_t> by_motion(const Paths& paths) {
  std::vector<uint32_t> group;
  for (int64_t path = 0; path < paths.num_paths(); ++path) {
    const Hit* hits = paths.hits_of(path);
    const auto count = paths.num_bounces[static_cast<size_t>(path)];
    group.push_back(std::all_of(hits, hits + count, [](const Hit& hit) { return hit.mesh_id == 0; }) ? 0 : 1);
  }
  return group;
}

void expect_slow_powers(const Paths& paths, const Radar& radar, const std::vector<uint32_t>& group,
                        const PartPass::Sets& sets) {
  PartPass pass(paths, radar, group, 3, {});
  const std::vector<SetPower> powers = pass.powers(sets, Window{}, 1, 0.0, nullptr);
  ASSERT_EQ(powers.size(), sets.size());
  for (size_t set = 0; set < sets.size(); ++set) {
    std::vector<double> expected;
    double mean_square = 0.0;
    for (const int channel : {0, 1}) {
      const std::vector<std::complex<double>> samples = slow_samples(paths, radar, channel, group, sets[set]);
      for (const std::complex<double>& sample : samples)
        mean_square += 0.5 * std::norm(sample) / static_cast<double>(samples.size());
      const std::vector<double> power = slow_power(samples, radar.waveform, Window{}, 1);
      expected.resize(power.size());
      for (size_t i = 0; i < power.size(); ++i) expected[i] += 0.5 * power[i];
    }
    const double largest = *std::max_element(expected.begin(), expected.end());
    ASSERT_GT(largest, 0.0);
    for (size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(powers[set].cells[i], expected[i], kSignal * largest) << i;
    if (sets[set].size() == 1) EXPECT_NEAR(powers[set].mean_square, mean_square, kSignal * mean_square);
    else EXPECT_EQ(powers[set].mean_square, 0.0);
  }
}

TEST(PartPass, PowersOfSetsAreThoseOfTheSlowSums) {
  const Radar radar = radar_of();
  const Paths paths = paths_of(radar);
  ASSERT_GT(paths.num_paths(), 100);
  expect_slow_powers(paths, radar, every_third(paths), {{2}, {0, 1}});
}

TEST(PartPass, PowersOfWhatStandsStillAreThoseOfTheSlowSums) {
  const Radar radar = radar_of();
  const Paths paths = paths_of(radar);
  expect_slow_powers(paths, radar, by_motion(paths), {{0}, {1}});
}

TEST(PartPass, RangesThatAreAskedForHaveTheSamePowers) {
  const Radar radar = radar_of();
  const Paths paths = paths_of(radar);
  PartPass pass(paths, radar, every_third(paths), 3, {});
  const SetPower whole = pass.powers({{1}}, Window{}, 1, 0.0, nullptr).front();
  const size_t num_ranges = whole.cells.size() / static_cast<size_t>(radar.waveform.num_chirps);
  std::vector<uint8_t> asked(num_ranges);
  const auto strongest = std::max_element(whole.cells.begin(), whole.cells.end()) - whole.cells.begin();
  asked[static_cast<size_t>(strongest) % num_ranges] = asked.back() = 1;
  const SetPower some = pass.powers({{1}}, Window{}, 1, 0.0, nullptr, {asked}).front();
  const double rounding = kSums * whole.cells[static_cast<size_t>(strongest)];
  for (size_t i = 0; i < whole.cells.size(); ++i) {
    if (asked[i % num_ranges]) EXPECT_NEAR(some.cells[i], whole.cells[i], rounding) << i;
    else EXPECT_EQ(some.cells[i], 0.0) << i;
  }
  EXPECT_NEAR(some.mean_square, whole.mean_square, kSums * whole.mean_square);
  EXPECT_THROW(pass.powers({{1}}, Window{}, 1, 0.0, nullptr, {{1}}), std::invalid_argument);
  EXPECT_THROW(pass.powers({{1}}, Window{}, 1, 0.0, nullptr, {asked, asked}), std::invalid_argument);
}

// Another pass, which makes only the group, is the truth.
TEST(PartPass, GroupsOfASetAreNotMadeAgainAlone) {
  const Radar radar = radar_of();
  const Paths paths = paths_of(radar);
  PartPass pass(paths, radar, every_third(paths), 3, {}), fresh(paths, radar, every_third(paths), 3, {});
  pass.powers({{0, 2}, {1}}, Window{}, 1, 0.0, nullptr);
  Job replayed, taken;
  const SetPower expected = fresh.powers({{2}}, Window{}, 1, 0.0, &replayed).front();
  const SetPower found = pass.powers({{2}}, Window{}, 1, 0.0, &taken).front();
  EXPECT_EQ(replayed.fraction(), 1.0);
  EXPECT_EQ(taken.fraction(), 0.0);  // of no paths
  const double largest = *std::max_element(expected.cells.begin(), expected.cells.end());
  ASSERT_GT(largest, 0.0);
  for (size_t i = 0; i < expected.cells.size(); ++i) EXPECT_NEAR(found.cells[i], expected.cells[i], kSums * largest) << i;
  EXPECT_NEAR(found.mean_square, expected.mean_square, kSums * expected.mean_square);
}

TEST(PartPass, EveryGroupMadeOnceAddsUpToTheWhole) {
  const Radar radar = radar_of();
  const Paths paths = paths_of(radar);
  PartPass pass(paths, radar, every_third(paths), 3, {});
  const std::vector<Cube> some = pass.cubes({{1}}, nullptr);
  pass.powers({{0}}, Window{}, 1, 0.0, nullptr);
  pass.bounds({{2}}, Window{}, 1, nullptr);
  pass.set_adds_up(false);
  pass.cubes({{0}, {2}}, nullptr);
  std::vector<std::complex<double>> expected = slow_samples(paths, radar, 1, std::vector<uint32_t>(paths.num_paths()), {0});
  const Cube whole = pass.whole(nullptr);
  double largest = 0.0, difference = 0.0;
  for (size_t i = 0; i < expected.size(); ++i) {
    largest = std::max(largest, std::abs(expected[i]));
    difference = std::max(difference, std::abs(whole.values[expected.size() + i] - expected[i]));
  }
  EXPECT_LT(difference, kSignal * largest);
  EXPECT_EQ(some.size(), 1u);
}

TEST(PartPass, CubesAreLinearInTheirSets) {
  const Radar radar = radar_of();
  const Paths paths = paths_of(radar);
  PartPass pass(paths, radar, every_third(paths), 3, {});
  pass.set_adds_up(false);
  const std::vector<Cube> alone = pass.cubes({{0}, {2}}, nullptr), both = pass.cubes({{0, 2}}, nullptr);
  double largest = 0.0;
  for (const std::complex<double>& value : both[0].values) largest = std::max(largest, std::abs(value));
  for (size_t i = 0; i < both[0].values.size(); ++i) {
    ASSERT_LT(std::abs(alone[0].values[i] + alone[1].values[i] - both[0].values[i]), kSums * largest);
  }
}

TEST(PartPass, BoundsHoldForThePowers) {
  const Radar radar = radar_of();
  const Paths paths = paths_of(radar);
  PartPass pass(paths, radar, every_third(paths), 3, {});
  pass.set_adds_up(false);
  for (const PartPass::Sets& sets : {PartPass::Sets{{0}, {1}, {2}}, PartPass::Sets{{1}, {0, 2}}}) {
    const std::vector<double> bounds = pass.bounds(sets, Window{}, 1, nullptr);
    const std::vector<SetPower> powers = pass.powers(sets, Window{}, 1, 0.0, nullptr);
    const auto num_ranges = bounds.size() / sets.size();
    for (size_t set = 0; set < sets.size(); ++set) {
      for (size_t i = 0; i < powers[set].cells.size(); ++i)
        EXPECT_LE(powers[set].cells[i], bounds[set * num_ranges + i % num_ranges]);
    }
  }
}

TEST(PartPass, NumberOfThreadsDoesNotMatter) {
  const Radar radar = radar_of();
  const Paths paths = paths_of(radar);
  test::same_on_any_threads([&] {
    PartPass pass(paths, radar, every_third(paths), 3, {});
    return pass.powers({{1}, {0}}, Window{}, 1, 0.0, nullptr).front().cells;
  });
}

TEST(PartPass, NoPathsAndBadGroups) {
  const Radar radar = radar_of();
  const Paths none = trace(Scene(), radar, {});
  PartPass pass(none, radar, {}, 1, {});
  const std::vector<SetPower> silent = pass.powers({{0}}, Window{}, 1, 0.0, nullptr);
  for (const double cell : silent.front().cells) EXPECT_EQ(cell, 0.0);
  EXPECT_THROW(pass.powers({{1}}, Window{}, 1, 0.0, nullptr), std::invalid_argument);
  EXPECT_THROW(PartPass(none, radar, {0}, 1, {}), std::invalid_argument);
}

}  // namespace
}  // namespace echopath::test_part_pass
