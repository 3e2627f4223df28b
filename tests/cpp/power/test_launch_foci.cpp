// Foci: cones inside a stratum with rays that lie closer. Echoes stay what they are.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

#include "cpp/support/scenes.h"
#include "echopath/base/random.h"
#include "echopath/power/received_power.h"
#include "echopath/trace/launch/launch_focus.h"

namespace echopath::test_launch_foci {
namespace {

using namespace testing;

constexpr double kRounding = 1e-12;
constexpr double kDiffuse = 5e-3;  // relative, of the power of 20 000 hits of a lattice
constexpr double kWeakest = 1e-3;  // of the whole, of ways that are compared
constexpr double kOfAWay = 0.05;   // relative, of ways over two diffuse hits, which are drawn at random
constexpr double kFlank = 1e-3;    // relative, of the rim of a focus
constexpr double kSphereDb = 0.1;  // of a metal sphere of 1280 facets against geometrical optics, with foci or without

Stratum cone(const Vec3& axis, double versine, double density, int focus_of = -1) {
  Stratum made;
  made.axis = axis;
  made.versine = versine;
  made.num_rays = 1000;
  made.ray_density = density;
  made.focus_of = focus_of;
  return made;
}

TEST(LaunchFoci, PartsOfADirectionAddUpToOne) {
  const Vec3 first = Vec3::UnitX(), second = Vec3(1, 0.01, 0).normalized();
  const std::vector<Stratum> strata = {cone(first, 0.01, 1e3), cone(first, 2e-4, 5e3, 0), cone(second, 1e-4, 2e4, 0),
                                       cone(first, 1.0, 7.0)};
  const LaunchFoci foci(strata);
  EXPECT_EQ(foci.owner(2), 0);
  EXPECT_EQ(foci.rays_of_owner(3, first), 1.0);
  int num_shared = 0;
  for (uint32_t i = 0; i < 1000; ++i) {
    const auto at = uniform2(1, Stream::kLaunchShift, i, 0);
    const Vec3 direction = Vec3(1, 0.06 * (at[0] - 0.5), 0.06 * (at[1] - 0.5)).normalized();
    double sum = 0.0;
    for (int stratum = 0; stratum < 3; ++stratum) {
      const double part = foci.rays_of_owner(stratum, direction) * strata[static_cast<size_t>(stratum)].ray_density / 1e3;
      EXPECT_GE(part, 0.0);
      num_shared += part > 0.0 && part < 1.0;
      sum += part;
    }
    EXPECT_NEAR(sum, 1.0, kRounding);
  }
  EXPECT_GT(num_shared, 100);
}

TEST(LaunchFoci, WeightIsOneInTheCoreAndFadesWithLevelEnds) {
  const Stratum focus = cone(Vec3::UnitX(), 5e-5, 1.0);  // 10 mrad
  const auto weight = [&](double radius) {
    return focus_weight(focus, Vec3(std::cos(0.01 * radius), std::sin(0.01 * radius), 0));
  };
  EXPECT_EQ(weight(0.59), 1.0);
  EXPECT_EQ(weight(1.01), 0.0);
  EXPECT_NEAR(weight(0.8), 0.5, kFlank);
  for (const double end : {kFocusCore, 1.0}) EXPECT_LT(std::abs(weight(end + 0.01) - weight(end - 0.01)), kFlank);
}

// A ray whose part of its direction is below zero has a root of a negative area as its amplitude.
TEST(LaunchFoci, NoPartOfADirectionIsBelowZero) {
  const std::vector<Stratum> strata = {cone(Vec3::UnitX(), 0.01, 1e3), cone(Vec3::UnitX(), 5e-5, 5e3, 0)};
  const LaunchFoci foci(strata);
  for (int i = 0; i < 100000; ++i) {
    const double angle = 0.01 * (kFocusCore + 1e-10 * i);  // just behind the core
    const Vec3 direction(std::cos(angle), std::sin(angle), 0);
    ASSERT_GE(foci.rays_of_owner(0, direction), 0.0) << i;
  }
}

Radar radar() { return plain_radar(Vec3::Zero(), Vec3::Zero()); }

Scene two_balls(bool is_rough) {
  Scene scene;
  for (const double y : {-1.0, 1.0}) {
    const Surface surface = ellipsoid({10, y, 0}, {0.1, 0.1, 0.1}, 4);
    Node ball = node_with(y < 0 ? "right" : "left", surface, is_rough ? lambert(0.3) : share(Material::metal()), !is_rough);
    scene.add(ball);
  }
  return scene;
}

// Two foci that overlap, in front of the left ball, with as many rays as its stratum keeps.
LaunchGuide guide() {
  LaunchGuide guide;
  guide.shares = {{"left", 10000.0}, {"right", 20000.0}, {"field of view", 0.0}};
  for (const double y : {1.0, 1.03}) guide.foci.push_back({"left", Vec3(10, y, 0.5 * (y - 1.0)).normalized(), 2e-5, 5000.0});
  return guide;
}

Paths shot(const Scene& scene, const LaunchGuide& guide, int batches = 1) {
  TraceSettings settings = with_rays(40000);
  settings.guide = guide;
  settings.batches = batches;
  return trace(scene, radar(), settings);
}

Paths of_left(const Paths& paths) {
  std::vector<uint8_t> keep;
  for (int64_t path = 0; path < paths.num_paths(); ++path) keep.push_back(paths.hits_of(path)->mesh_id == 1);
  return paths.select(keep);
}

TEST(LaunchFoci, LeaveDiffusePowerAsItIs) {
  const Scene scene = two_balls(true);
  const Paths with = of_left(shot(scene, guide())), without = of_left(shot(scene, {}));
  ASSERT_EQ(with.frame.strata[2].focus_of, 1);
  ASSERT_GT(with.num_paths(), without.num_paths() / 2);
  EXPECT_NEAR(received_power(with).diffuse / received_power(without).diffuse, 1.0, kDiffuse);
}

TEST(LaunchFoci, LeaveTheEchoOfASphereAsItIs) {
  const Scene scene = two_balls(false);
  // Geometrical optics: the wave front that meets the sphere at the distance r spreads as if it came from r a/(a + 2 r)
  // behind it.
  const double wavelength = kSpeedOfLight / radar().waveform.start_frequency, radius = 0.1,
               range = std::sqrt(101.0) - radius;
  const double field = wavelength / (4.0 * kPi * range) * radius / (2.0 * (radius + range)), expected = field * field;
  for (const int batches : {1, 4}) {
    const double power = received_power(of_left(shot(scene, guide(), batches))).power;
    EXPECT_NEAR(10.0 * std::log10(power / expected), 0.0, kSphereDb) << batches;
  }
}

// W, by the meshes that paths touch, in order.
std::map<std::vector<uint32_t>, double> power_by_way(const Paths& paths) {
  std::map<std::vector<uint32_t>, uint32_t> group_of_way;
  std::vector<uint32_t> group;
  for (int64_t path = 0; path < paths.num_paths(); ++path) {
    std::vector<uint32_t> way;
    for (int k = 0; k < paths.num_bounces[static_cast<size_t>(path)]; ++k) way.push_back(paths.hits_of(path)[k].mesh_id);
    group.push_back(group_of_way.try_emplace(std::move(way), static_cast<uint32_t>(group_of_way.size())).first->second);
  }
  const std::vector<ReceivedPower> powers = received_powers(paths, Sorting{group, group_of_way.size()});
  std::map<std::vector<uint32_t>, double> out;
  for (const auto& [way, index] : group_of_way) out[way] = powers[index].power;
  return out;
}

// Rough balls before a rough flagged wall: pairs of legs, chains of two diffuse hits and their opposite orders, images.
TEST(LaunchFoci, LeaveEveryWayAsItIsInBothPolarisations) {
  Scene scene = two_balls(true);
  Material wall;
  wall.permittivity = std::complex<double>(5.0, -0.3);
  wall.scattering = 0.4;
  wall.mirror = true;
  add_rectangle(scene, "wall", {5, 2.5, -3}, {12, 0, 0}, {0, 0, 6}, share(wall));
  for (const PolarizationModel model : {PolarizationModel::kScalar, PolarizationModel::kJones}) {
    TraceSettings settings = with_rays(400000, 3);
    settings.polarization = model;
    const Paths even = trace(scene, radar(), settings);
    settings.guide = guide_like(even.frame.strata);
    for (const Stratum& stratum : even.frame.strata) {
      settings.guide.shares[stratum.name] *= 0.7;
      const double versine = std::min(0.3 * stratum.versine, 0.05);  // some hang over the rim of what they are in
      const Vec3 aside = (stratum.axis + 0.8 * std::sqrt(2.0 * versine) * stratum.axis.unitOrthogonal()).normalized();
      settings.guide.foci.push_back({stratum.name, aside, versine, 0.3 * static_cast<double>(stratum.num_rays)});
    }
    const auto with = power_by_way(trace(scene, radar(), settings)), without = power_by_way(even);
    double whole = 0.0;
    for (const auto& [way, power] : without) whole += power;
    int num_compared = 0;
    for (const auto& [way, power] : without) {
      if (power < kWeakest * whole) continue;
      EXPECT_NEAR(with.at(way) / power, 1.0, kOfAWay) << way.size() << " bounces, first " << way.front();
      ++num_compared;
    }
    EXPECT_GE(num_compared, 6);
  }
}

TEST(LaunchFoci, AGuideOfATraceRepeatsIt) {
  const Scene scene = two_balls(false);
  const Paths first = shot(scene, guide()), second = shot(scene, guide_like(first.frame.strata));
  ASSERT_EQ(second.frame.strata.size(), first.frame.strata.size());
  for (size_t k = 0; k < first.frame.strata.size(); ++k) {
    EXPECT_EQ(second.frame.strata[k].num_rays, first.frame.strata[k].num_rays) << first.frame.strata[k].name;
    EXPECT_EQ(second.frame.strata[k].name, first.frame.strata[k].name);
  }
  EXPECT_EQ(second.weight, first.weight);
}

TEST(LaunchFoci, OfNoStratumOrOfNoSizeAreRefused) {
  const Scene scene = two_balls(false);
  LaunchGuide flat = guide(), endless = guide(), alone = guide();
  flat.foci[0].versine = 0.0;
  endless.foci[1].share = std::numeric_limits<double>::infinity();
  alone.shares.clear();
  for (const LaunchGuide& bad : {flat, endless, alone}) EXPECT_THROW(shot(scene, bad), std::invalid_argument);
  Paths paths = shot(scene, guide());
  paths.frame.strata[2].focus_of = 3;
  EXPECT_THROW(paths.validate(), std::invalid_argument);
  paths.frame.strata[2].focus_of = 99;
  EXPECT_THROW(paths.validate(), std::invalid_argument);
}

}  // namespace
}  // namespace echopath::test_launch_foci
