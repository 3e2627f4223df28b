// Some faint paths for many: the power that is kept, against that of all paths; paths and their reversals, which arrive in
// phase.
#include <gtest/gtest.h>

#include <bit>
#include <map>
#include <set>

#include "cpp/support/scenes.h"
#include "echopath/power/faint_paths.h"
#include "echopath/power/path_power.h"
#include "echopath/power/received_power.h"

namespace echopath::test_faint_paths {
namespace {

using namespace testing;

constexpr int kRays = 4000, kSeeds = 12;
constexpr double kFiveSigma = 5.0;
constexpr double kSingle = 1e-6;  // relative, of a power: single precision of weights

// Mirrors a tenth of the power.
MaterialPtr faint_mirror() {
  Material mirror;
  mirror.reflectivity = 0.1;
  mirror.mirror = true;
  return share(mirror);
}

// A rough plate beside a wall and over a floor that are mirrors: each hit makes up to 5 x 5 paths.
Scene corner_scene() {
  Scene scene;
  add_rectangle(scene, "wall", {-1, 2, -1}, {14, 0, 0}, {0, 0, 4}, faint_mirror());
  add_rectangle(scene, "floor", {-1, -6, -1}, {14, 0, 0}, {0, 8, 0}, faint_mirror());
  add_rectangle(scene, "plate", {8, -0.5, -0.5}, {0.6, 1, 0}, {0, 0, 1}, lambert(0.3));
  return scene;
}

// The diffuse paths.
Paths traced(uint64_t seed = 1, const Radar& radar = plain_radar({0, 0, 0}, {0, 0, 0})) {
  TraceSettings settings = with_rays(kRays);
  settings.seed = seed;
  const Paths paths = trace(corner_scene(), radar, settings);
  std::vector<uint8_t> keep;
  for (const uint64_t diffuse : paths.diffuse) keep.push_back(diffuse != 0);
  Paths found = paths.select(keep);
  found.frame.statistics.num_paths = found.num_paths();
  return found;
}

double sum(const std::vector<double>& values) {
  double total = 0.0;
  for (const double value : values) total += value;
  return total;
}

double largest_power(const Paths& paths) {
  const std::vector<double> power = path_power(paths);
  return *std::max_element(power.begin(), power.end());
}

// Mesh IDs and the place of the diffuse hit: which path of a record this is.
using Name = std::vector<uint32_t>;
Name name_of(const Paths& paths, int64_t path) {
  Name name;
  for (int k = 0; k < paths.num_bounces[static_cast<size_t>(path)]; ++k) {
    const Hit& hit = paths.hits_of(path)[k];
    name.push_back(hit.mesh_id);
    if (!(paths.diffuse[static_cast<size_t>(path)] >> k & 1)) continue;
    name.insert(name.end(), {hit.triangle_id, std::bit_cast<uint32_t>(hit.u), std::bit_cast<uint32_t>(hit.v), 99u});
  }
  return name;
}

// The diffuse hit of a path.
Name hit_of(const Paths& paths, int64_t path) {
  const Hit& hit = paths.hits_of(path)[std::countr_zero(paths.diffuse[static_cast<size_t>(path)])];
  return {hit.mesh_id, hit.triangle_id, std::bit_cast<uint32_t>(hit.u), std::bit_cast<uint32_t>(hit.v)};
}

// A name without the plate is returned as it is.
Name reversed(const Name& name) {
  const auto place = std::find(name.begin(), name.end(), 2u);  // the plate's ID, then where it is hit
  if (place == name.end()) return name;
  Name other(place + 5, name.end());
  std::reverse(other.begin(), other.end());
  other.insert(other.end(), place, place + 5);
  other.insert(other.end(), std::reverse_iterator(place), name.rend());
  return other;
}

TEST(FaintPaths, KeepTheMeanPower) {
  double all = 0.0, kept = 0.0, variance = 0.0;
  for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Paths paths = traced(seed);
    const double faint = 0.5 * largest_power(paths);
    Paths asked = paths;
    asked.frame.faint_power = faint;
    const Paths some = thinned(asked);
    EXPECT_LT(some.num_paths(), paths.num_paths() * 3 / 4);
    all += sum(path_power(paths));
    kept += sum(path_power(some));
    // A path of the power p is kept with the power 4^n p <= faint in one of 4^n draws. Those of one hit share a draw.
    std::map<Name, double> faint_of_hit;
    const std::vector<double> power = path_power(paths);
    for (int64_t path = 0; path < paths.num_paths(); ++path)
      if (power[static_cast<size_t>(path)] < faint / 4.0)
        faint_of_hit[hit_of(paths, path)] += std::sqrt(power[static_cast<size_t>(path)] * faint);
    for (const auto& [hit, root] : faint_of_hit) variance += root * root;
  }
  EXPECT_NEAR(kept, all, kFiveSigma * std::sqrt(variance));
  EXPECT_LT(kFiveSigma * std::sqrt(variance), 0.05 * all);  // so that the line above tells something
}

TEST(FaintPaths, HaveTheirPowerTimesAPowerOfFourUpToTheFaintPower) {
  const Paths paths = traced();
  const double faint = 0.5 * largest_power(paths);
  Paths asked = paths;
  asked.frame.faint_power = faint;
  const Paths some = thinned(asked);
  std::map<Name, double> power_of;
  const std::vector<double> before = path_power(paths), after = path_power(some);
  for (int64_t path = 0; path < paths.num_paths(); ++path)
    power_of[name_of(paths, path)] = before[static_cast<size_t>(path)];
  std::set<int> levels;
  for (int64_t path = 0; path < some.num_paths(); ++path) {
    const Name name = name_of(some, path);
    const double power = after[static_cast<size_t>(path)], ratio = power / power_of.at(name);
    const double stronger = ratio * std::max(power_of[name], power_of[reversed(name)]);
    const int level = static_cast<int>(std::lround(std::log(ratio) / std::log(4.0)));
    levels.insert(level);
    EXPECT_NEAR(ratio, std::pow(4.0, level), kSingle * ratio);
    EXPECT_TRUE(level == 0 || stronger <= faint * (1.0 + kSingle));
    EXPECT_TRUE(level == 3 || stronger > faint / 4.0 * (1.0 - kSingle));
  }
  EXPECT_EQ(levels, (std::set<int>{0, 1, 2, 3}));
  EXPECT_EQ(some.frame.statistics.num_faint_paths, paths.num_paths() - some.num_paths());
  EXPECT_EQ(some.frame.statistics.num_paths, some.num_paths());
  some.validate();
}

// A transmitter that looks toward the wall makes a path over it much stronger than its reversal.
TEST(FaintPaths, AreKeptForCertainWhereTheirReversalsAreNotFaint) {
  Radar radar = plain_radar({0, 0, 0}, {0, 0, 0});
  radar.transmitters[0].pattern = AntennaPattern::cosine_power(40.0);
  radar.transmitters[0].orientation = turned(0.5, 0.0);
  Paths asked = traced(1, radar);
  asked.frame.faint_power = 0.1 * largest_power(asked);
  const Paths some = thinned(asked);
  std::map<Name, double> power_of;
  std::set<Name> kept;
  const std::vector<double> before = path_power(asked);
  for (int64_t path = 0; path < asked.num_paths(); ++path)
    power_of[name_of(asked, path)] = before[static_cast<size_t>(path)];
  for (int64_t path = 0; path < some.num_paths(); ++path) kept.insert(name_of(some, path));
  const double least = 0.25 * (1.0 + kSingle) * asked.frame.faint_power;
  int num_certain = 0;
  for (const auto& [name, power] : power_of) {
    const auto other = power_of.find(reversed(name));
    if (other == power_of.end() || power > least || other->second < least) continue;
    ++num_certain;
    EXPECT_TRUE(kept.contains(name) && kept.contains(other->first));
  }
  EXPECT_GT(num_certain, 100);
}

// Between antennas in one place a pair of legs and the pair exchanged are one path and its reversal. Were one kept without
// the other, what adds up in phase would be lost.
TEST(FaintPaths, AreKeptTogetherWithTheirReversals) {
  Paths asked = traced();
  asked.frame.faint_power = largest_power(asked);
  const Paths some = thinned(asked);
  std::set<Name> all, kept;
  for (int64_t path = 0; path < asked.num_paths(); ++path) all.insert(name_of(asked, path));
  for (int64_t path = 0; path < some.num_paths(); ++path) kept.insert(name_of(some, path));
  int num_pairs = 0;
  for (const Name& name : kept) {
    const Name other = reversed(name);
    EXPECT_EQ(kept.contains(other), all.contains(other));  // at the rim of a mirror one of the two may be hidden
    num_pairs += other != name && all.contains(other);
  }
  EXPECT_GT(num_pairs, 100);
}

// The mesh IDs of a path in order, whichever way it goes.
std::vector<uint32_t> meshes_met(const Paths& paths, int64_t path) {
  std::vector<uint32_t> met;
  for (int k = 0; k < paths.num_bounces[static_cast<size_t>(path)]; ++k) met.push_back(paths.hits_of(path)[k].mesh_id);
  std::ranges::sort(met);
  return met;
}

// A hand's breadth beside a wall and over a floor, "wall, plate, floor" and "plate, floor, wall" are one length to some 60
// micrometres (by the square roots of their images), and so are their reversals: four times the sum of their powers arrives.
TEST(FaintPaths, KeepWhatArrivesInPhaseOverTwoMirrorsInEitherOrder) {
  Scene scene;
  add_rectangle(scene, "wall", {-1, 0.3, -4}, {14, 0, 0}, {0, 0, 8}, faint_mirror());
  add_rectangle(scene, "floor", {-1, -4, -0.3}, {14, 0, 0}, {0, 8, 0}, faint_mirror());
  add_rectangle(scene, "plate", {8, -0.05, -0.05}, {0, 0.1, 0}, {0, 0, 0.1}, lambert(0.3));
  double in_phase = 0.0, kept = 0.0, alone = 0.0;
  for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
    TraceSettings settings = with_rays(kRays);
    settings.seed = seed;
    const Paths paths = trace(scene, plain_radar({0, 0, 0}, {0, 0, 0}), settings);
    std::vector<uint8_t> keep;
    for (int64_t path = 0; path < paths.num_paths(); ++path)
      keep.push_back(meshes_met(paths, path) == std::vector<uint32_t>{0, 1, 2});
    Paths over_both = paths.select(keep);
    alone += sum(path_power(over_both));
    in_phase += received_power(over_both).diffuse;
    over_both.frame.faint_power = 8.0 * largest_power(over_both);  // all are so strong that one in four stands for them
    const Paths some = thinned(over_both);
    EXPECT_LT(some.num_paths(), over_both.num_paths() / 3);
    kept += received_power(some).diffuse;
  }
  EXPECT_NEAR(in_phase, 4.0 * alone, 0.02 * in_phase);
  EXPECT_NEAR(kept, in_phase, 0.05 * in_phase);  // five times sqrt(3 / number of hits)
}

// What only the second receiver sees is not faint, though the first one is blind there.
TEST(FaintPaths, AreFaintBetweenAllAntennas) {
  Radar radar = plain_radar({0, 0, 0}, {0, 0, 0});
  Antenna away = radar.receivers[0];
  away.pattern = AntennaPattern::cosine_power(2.0);
  away.orientation = turned(kPi, 0.0);
  radar.receivers.insert(radar.receivers.begin(), away);
  Paths asked = traced(1, radar);
  asked.frame.faint_power = 1e-12 * largest_power(traced());
  EXPECT_LT(largest_power(asked), 1e-3 * asked.frame.faint_power);
  EXPECT_EQ(thinned(asked).num_paths(), asked.num_paths());
}

Antenna looking(const AntennaPattern& pattern, double yaw) {
  Antenna antenna = antenna_at(Vec3::Zero());
  antenna.pattern = pattern;
  antenna.orientation = turned(yaw, 0.0);
  return antenna;
}

// A gain of 1 from one azimuth to another, and none elsewhere.
AntennaPattern sector(double from, double to) {
  return AntennaPattern::of_table(GainTable({from, to}, {-kPi / 2, kPi / 2}, std::vector<double>(4, 1.0)));
}

// A blind receiver and one that sees, which differ in one property alone: what the second one sees is not faint.
TEST(FaintPaths, AreFaintBetweenAntennasThatDifferInOneProperty) {
  AntennaPattern isotropic = AntennaPattern::cosine_power(2.0);
  isotropic.kind = AntennaPattern::Kind::kIsotropic;
  const double aside = 0.45 * kPi;
  const std::pair<Antenna, Antenna> pairs[] = {
      {looking(AntennaPattern::cosine_power(2.0), kPi), looking(isotropic, kPi)},
      {looking(AntennaPattern::isotropic(1e-16), 0.0), looking(AntennaPattern::isotropic(), 0.0)},
      {looking(AntennaPattern::cosine_power(300.0, 1.0), aside), looking(AntennaPattern::cosine_power(1.0, 1.0), aside)},
      {looking(sector(2.0, 4.0), 0.0), looking(sector(-1.0, 1.0), 0.0)},
      {looking(AntennaPattern::cosine_power(2.0), kPi), looking(AntennaPattern::cosine_power(2.0), 0.0)}};
  for (size_t i = 0; i < std::size(pairs); ++i) {
    Radar radar = plain_radar({0, 0, 0}, {0, 0, 0});
    radar.receivers = {pairs[i].first, pairs[i].second};
    Paths asked = traced(1, radar);
    asked.frame.faint_power = 1e-12 * largest_power(traced());
    EXPECT_LT(largest_power(asked), 1e-3 * asked.frame.faint_power) << i;
    EXPECT_EQ(thinned(asked).num_paths(), asked.num_paths()) << i;
  }
}

TEST(FaintPaths, AreCountedBesideThoseThatWereLeftOutBefore) {
  Paths asked = traced();
  asked.frame.faint_power = largest_power(asked);
  asked.frame.statistics.num_faint_paths = 7;
  const Paths some = thinned(asked);
  EXPECT_LT(some.num_paths(), asked.num_paths());
  EXPECT_EQ(some.frame.statistics.num_faint_paths, 7 + asked.num_paths() - some.num_paths());
}

// Where nothing is asked for, paths without any power stay, too.
TEST(FaintPaths, AreNoneOfNoPowerWhereNothingIsAskedFor) {
  Radar radar = plain_radar({0, 0, 0}, {0, 0, 0});
  radar.receivers = {looking(AntennaPattern::cosine_power(2.0), kPi)};
  const Paths dark = traced(1, radar);
  EXPECT_EQ(largest_power(dark), 0.0);
  EXPECT_EQ(thinned(dark).num_paths(), dark.num_paths());
}

TEST(FaintPaths, AreNoCoherentOnesAndNoneWhereNothingIsAskedFor) {
  Scene scene;
  add_smooth_ball(scene, "ball", {10, 0, 0}, 0.1, 3);
  TraceSettings settings = with_rays(kRays);
  settings.faint_power = 1.0;
  Paths coherent = trace(scene, plain_radar({0, 0, 0}, {0, 0, 0}), settings);
  EXPECT_EQ(thinned(coherent).weight, coherent.weight);
  const Paths rough = traced();
  EXPECT_EQ(thinned(rough).weight, rough.weight);
}

}  // namespace
}  // namespace echopath::test_faint_paths
