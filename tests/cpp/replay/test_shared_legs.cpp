// Paths put together from the legs that they share are those that are evaluated one by one.
#include <gtest/gtest.h>

#include "cpp/replay/small_arrays.h"
#include "cpp/support/path_by_path.h"
#include "cpp/support/scenes.h"
#include "echopath/base/constants.h"
#include "echopath/replay/evaluate/shared_leg_plan.h"
#include "echopath/replay/evaluate/shared_legs.h"
#include "echopath/replay/evaluate/single_bounces.h"
#include "echopath/replay/posed/hit_patches.h"

namespace echopath::test_shared_legs {
namespace {

using namespace testing;

constexpr double kRounding = 1e-13;  // relative: sums and products of about ten factors in another order
// relative: cosines near zero are differences of products of order one; at the rim of an antenna that is dark behind, 1e-5
// of its gain and less
constexpr double kGrazingRounding = 3e-11;
// relative: footprints are exponentials, and multiply the rounding of thousands of rad; cells of the plate, which rays of
// its own graze, stretch a thousandfold; edges are three footprints
constexpr double kFilterRounding = 1e-6;
constexpr double kFaintest = 1e-11;  // sqrt(W): flat-top footprints are differences from one, of echoes of 1e-6

MaterialPtr rough(double diffuse_share, bool mirror) {
  Material material;
  material.permittivity = std::complex<double>(5.0, -0.3);
  material.scattering = std::sqrt(diffuse_share);
  material.mirror = mirror;
  return share(material);
}

void add_body(Scene& scene, const std::string& name, const Vec3& centre, const Transform& placement,
              std::shared_ptr<const Motion> motion, bool smooth = false) {
  Surface surface = ellipsoid(Vec3::Zero(), {.4, .3, .5}, 3);
  Node node;
  node.name = name;
  node.placement = Eigen::Translation3d(centre) * placement;
  node.mesh = std::make_shared<Mesh>(std::move(surface.vertices), std::move(surface.triangles));
  node.material = rough(0.5, false);
  node.motion = std::move(motion);
  node.smooth = smooth;
  scene.add(node);
}

// Mirrors that scatter too, of which one drives away; bodies that turn, one of them smooth, one stretched along its way, one
// that stands, all but flat.
Scene scene_of_all_kinds(bool has_mirrors = true) {
  Scene scene;
  add_rectangle(scene, "left", {-20, 3, -1}, {60, 0, 0}, {0, 0, 12}, rough(0.2, has_mirrors));
  add_rectangle(scene, "ground", {-20, -20, -1}, {60, 0, 0}, {0, 40, 0}, rough(0.1, has_mirrors));
  add_rectangle(scene, "van", {14, -3, -1}, {0, 6, 0}, {0, 0, 3}, rough(0.2, has_mirrors),
                std::make_shared<LinearMotion>(Vec3(12, 0, 0)));
  const auto turns = std::make_shared<LinearMotion>(Vec3(-3, 1, 0), Vec3(0.5, 1, 4));
  add_body(scene, "near", {6, 0.5, 0}, Transform::Identity(), turns);
  add_body(scene, "smooth", {8, 1.5, 0.5}, Transform(Eigen::Scaling(0.7)), turns, true);
  add_body(scene, "far", {9, -1, 0.3}, Transform(Eigen::Scaling(1.0, 2.0, 0.5)), turns);
  add_body(scene, "plate", {7, -2, 0.2},
           Transform(Eigen::AngleAxisd(0.7, Vec3(0.1, 0.2, 1).normalized()) * Eigen::Scaling(1.0, 3.0, 1e-6)), nullptr);
  return scene;
}

Radar array() {
  Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero());
  radar.transmitters.push_back(antenna_at({0, 0.02, 0.01}));
  for (const double y : {-0.02, 0.05}) radar.receivers.push_back(antenna_at({0, y, 0.02}));
  for (Antenna& antenna : radar.receivers) antenna.pattern = AntennaPattern::cosine_power(3.0);
  radar.transmitters[1].pattern = AntennaPattern::cosine_power(2.5);
  radar.transmitters[1].orientation = Quaternion(Eigen::AngleAxisd(0.3, Vec3::UnitZ()));
  radar.motion = std::make_shared<LinearMotion>(Vec3(5, 0, 0), Vec3(0, 0, 0.4));
  return radar;
}

Paths record(const Radar& radar, bool has_mirrors = true, PolarizationModel polarization = PolarizationModel::kScalar) {
  TraceSettings settings;
  settings.polarization = polarization;
  settings.num_rays = 1200;
  settings.max_bounces = 4;
  return trace(scene_of_all_kinds(has_mirrors), radar, settings);
}

// Largest differences to paths evaluated one by one, relative to each value, over all channels.
struct Differences {
  double length = 0.0, diffuse = 0.0, coherent = 0.0;  // amplitudes of diffuse and of coherent paths
};

// Amplitudes are held against what they are where polarisations agree, since these may cross.
Differences differences(const Paths& paths, const Radar& radar, double time,
                        SpecularPoints specular = SpecularPoints::kMaterial) {
  const std::vector<int64_t> indices = all_of(paths);
  std::vector<double> lengths;
  std::vector<std::complex<double>> amplitudes;
  ReplaySettings settings;
  settings.specular = specular;
  Replayer(paths, radar, settings).evaluate(indices, time, lengths, amplitudes);
  const PathByPath slowly(paths, radar, time, specular);
  Differences largest;
  for (size_t p = 0; p < indices.size(); ++p) {
    const std::vector<PathValue> values = slowly(indices[p]);
    for (size_t channel = 0; channel < values.size(); ++channel) {
      const size_t at = channel * indices.size() + p;
      const double size = values[channel].largest;
      largest.length = std::max(largest.length, std::abs(lengths[at] / values[channel].length - 1.0));
      const double difference = std::abs(amplitudes[at] - values[channel].amplitude);
      if (paths.diffuse[p] != 0) largest.diffuse = std::max(largest.diffuse, size > 0.0 ? difference / size : difference);
      else largest.coherent = std::max(largest.coherent, difference / std::max(size, kFaintest));
    }
  }
  return largest;
}

void expect_equal(const Differences& largest) {
  EXPECT_LT(largest.length, kRounding);
  EXPECT_LT(largest.diffuse, kGrazingRounding);
  EXPECT_LT(largest.coherent, kFilterRounding);
}

TEST(SharedLegs, PathsAreThoseEvaluatedOneByOne) {
  const Radar radar = array();
  const Paths paths = record(radar);
  for (const double time : {paths.frame.trace_time, paths.frame.trace_time + 0.02}) {
    expect_equal(differences(paths, radar, time));
  }
}

// Points of reflection that slide do so for each antenna by itself.
TEST(SharedLegs, SlidingPathsAreThoseEvaluatedOneByOne) {
  for (const PolarizationModel model : {PolarizationModel::kScalar, PolarizationModel::kJones}) {
    Radar radar = array();
    radar.receivers[1].polarization = Vec3(0.0, 0.6, 0.8);
    for (const bool has_mirrors : {true, false}) {
      const Paths paths = record(radar, has_mirrors, model);
      for (const double time : {paths.frame.trace_time, paths.frame.trace_time + 0.02}) {
        expect_equal(differences(paths, radar, time, SpecularPoints::kFermat));
      }
    }
  }
}

// Every chirp has its nodes, which lanes evaluate side by side; one of them is the middle of the chirp.
TEST(SharedLegs, PathsAtManyNodesAreThoseEvaluatedOneByOne) {
  Radar radar = array();
  radar.waveform.num_chirps = 8;
  for (const SpecularPoints specular : {SpecularPoints::kMaterial, SpecularPoints::kFermat}) {
    const Paths paths = record(radar);
    ReplaySettings settings;
    settings.specular = specular;
    const Replayer replayer(paths, radar, settings);
    const std::vector<int64_t> indices = all_of(paths);
    PartlyPosedGrid partly = replayer.pose_partly(replayer.grids().samples(1));
    const PosedGrid& samples = partly.with(replayer.meshes_of(indices));
    const std::vector<Echoes> echoes = replayer.exact(indices, samples);
    const std::vector<double>& times = samples.nodes.times;
    const size_t num_receivers = radar.receivers.size(), node = times.size() / 2;
    const PathByPath slowly(paths, radar, times[node], specular);
    for (size_t p = 0; p < indices.size(); ++p) {
      const std::vector<PathValue> values = slowly(indices[p]);
      for (size_t rx = 0; rx < num_receivers; ++rx) {
        const PathValue& value = values[num_receivers + rx];
        const size_t at = node * indices.size() + p;
        ASSERT_NEAR(echoes[rx].delay[at] * kSpeedOfLight / value.length, 1.0, kRounding);
        ASSERT_LT(std::abs(echoes[rx].amplitude[at] - value.amplitude),
                  kFilterRounding * std::max(value.largest, kFaintest));
      }
    }
  }
}

// At both ends, by direction: over mirrors, behind sliding points, of reversed paths.
TEST(SharedLegs, PhasesOfAntennasTurnThePathsEvaluatedOneByOne) {
  Radar radar = array();
  const std::vector<double> angles = {-3.1, -1.5, 0.0, 1.0, 3.1};
  std::vector<double> gains, phases;
  for (int i = 0; i < 25; ++i) {
    gains.push_back(0.4 + 0.05 * (i * 7 % 11));
    phases.push_back(0.3 * (i * 5 % 7));
  }
  const auto table = AntennaPattern::of_table(GainTable(angles, {-1.5, -0.7, 0.0, 0.6, 1.5}, gains, phases));
  radar.transmitters[1].pattern = radar.receivers[0].pattern = table;
  for (const SpecularPoints specular : {SpecularPoints::kMaterial, SpecularPoints::kFermat}) {
    const Paths paths = record(radar);
    expect_equal(differences(paths, radar, paths.frame.trace_time + 0.01, specular));
  }
}

TEST(SharedLegs, TablesOfGainsAreReadInTheDirectionOfTheLeg) {
  Radar radar = array();
  const std::vector<double> angles = {-3.1, -1.5, 0.0, 1.0, 3.1};
  std::vector<double> gains;
  for (int i = 0; i < 25; ++i) gains.push_back(0.4 + 0.05 * (i * 7 % 11));
  radar.transmitters[1].pattern = AntennaPattern::of_table(GainTable(angles, {-1.5, -0.7, 0.0, 0.6, 1.5}, gains, {}));
  const Paths paths = record(radar);
  expect_equal(differences(paths, radar, paths.frame.trace_time + 0.01));
}

// Gains that kernels raise to powers themselves.
Radar array_of_powers() {
  Radar radar = array();
  radar.transmitters[1].pattern = AntennaPattern::cosine_power(2.0);
  return radar;
}

TEST(SharedLegs, PathsOfOnePointAreThoseEvaluatedOneByOne) {
  const Radar radar = array_of_powers();
  ASSERT_TRUE(can_evaluate_single_bounces(radar));
  for (const bool has_mirrors : {true, false}) {
    Paths paths = record(radar, has_mirrors);
    for (const Footprint footprint :
         {Footprint::kSecondOrder, Footprint::kNone, Footprint::kFirstOrder, Footprint::kEdges}) {
      paths.frame.footprint = footprint;
      expect_equal(differences(paths, radar, paths.frame.trace_time + 0.02));
    }
  }
}

// As one antenna that sends and receives, and as ones that differ in where they look.
TEST(SharedLegs, AntennasOfBothEndsMayBeTheSame) {
  Radar radar = array_of_powers();
  radar.receivers = radar.transmitters;
  for (const double turn : {0.0, 0.2}) {
    radar.receivers[1].orientation = Quaternion(Eigen::AngleAxisd(0.3 + turn, Vec3::UnitZ()));
    const Paths paths = record(radar, false);
    expect_equal(differences(paths, radar, paths.frame.trace_time + 0.02));
  }
}

// Upright antennas on a radar that turns about the vertical; others that tilt with it, one of them of horizontal
// polarisation.
TEST(SharedLegs, PolarizedPathsAreThoseEvaluatedOneByOne) {
  for (const bool is_upright : {true, false}) {
    Radar radar = array_of_powers();
    if (!is_upright) {
      radar.motion = std::make_shared<LinearMotion>(Vec3(5, 0, 0), Vec3(2.0, 3.0, 0.4));
      radar.receivers[1].polarization = Vec3::UnitY();
      radar.transmitters[0].polarization = Vec3(0.0, 0.6, 0.8);
    }
    for (const bool has_mirrors : {true, false}) {
      const Paths paths = record(radar, has_mirrors, PolarizationModel::kJones);
      ASSERT_EQ(paths.jones.size(), static_cast<size_t>(paths.num_paths()));
      expect_equal(differences(paths, radar, paths.frame.trace_time));
      expect_equal(differences(paths, radar, paths.frame.trace_time + 0.02));
    }
  }
}

struct SingleBounceCounts {
  size_t paths = 0, pairs = 0, others = 0;
  std::vector<int> of_mesh;
};

SingleBounceCounts single_bounce_counts(const Paths& paths) {
  const PathPreparer preparer(paths, hit_patches(paths));
  SharedLegPlanner planner;
  planner.begin(paths, preparer, SpecularPoints::kMaterial, true);
  const SharedLegPlan& plan = planner(all_of(paths));
  SingleBounceCounts counts;
  counts.others = plan.chains.size() + plan.mirror_paths.size();
  counts.of_mesh.resize(paths.scene->meshes().size());
  for (const SharedLegPlan::SingleBounce& point : plan.single_bounces) {
    const auto has = [&](size_t kind) { return size_t{point.path[kind] != SharedLegPlan::SingleBounce::kNoPath}; };
    counts.paths += has(0) + has(1);
    counts.pairs += has(0) & has(1);
    ++counts.of_mesh[point.hit->mesh_id];
  }
  return counts;
}

TEST(SharedLegs, PolarizedPathsAreSharedAsScalarOnes) {
  const Paths scalar = record(array_of_powers()), polarized = record(array_of_powers(), true, PolarizationModel::kJones);
  ASSERT_EQ(scalar.num_paths(), polarized.num_paths());
  EXPECT_EQ(scalar.hits->size(), polarized.hits->size());
  EXPECT_EQ(single_bounce_counts(scalar).paths, single_bounce_counts(polarized).paths);
  EXPECT_EQ(single_bounce_counts(scalar).others, single_bounce_counts(polarized).others);
}

TEST(SharedLegs, PathsOfOnePointStandApart) {
  const Paths over_mirrors = record(array_of_powers()), paths = record(array_of_powers(), false);
  for (const Paths* some : {&over_mirrors, &paths}) {
    const SingleBounceCounts counts = single_bounce_counts(*some);
    EXPECT_EQ(counts.paths + counts.others, static_cast<size_t>(some->num_paths()));
    EXPECT_GT(counts.of_mesh[0] + counts.of_mesh[1] + counts.of_mesh[2], 20);  // walls, ground
    EXPECT_GT(counts.of_mesh[3], 8);
    EXPECT_EQ(counts.of_mesh[4], 0);  // smooth
    EXPECT_EQ(counts.of_mesh[5], 0);  // stretched along its way
    EXPECT_GT(counts.of_mesh[6], 3);
  }
  EXPECT_GT(single_bounce_counts(paths).pairs, 100u);
}

// The scene has all kinds of paths that the first test is about, and they do share.
TEST(SharedLegs, RaysShareLegsAndPoints) {
  const Radar radar = array();
  const Paths paths = record(radar);
  const std::vector<int64_t> indices = all_of(paths);
  const PathPreparer preparer(paths, hit_patches(paths));
  SharedLegPlanner planner;
  planner.begin(paths, preparer, SpecularPoints::kMaterial, false);
  const SharedLegPlan& plan = planner(indices);
  EXPECT_EQ(plan.chains.size() + plan.mirror_paths.size(), indices.size());
  EXPECT_GT(plan.mirror_paths.size(), 2u);
  EXPECT_LT(plan.legs.size(), plan.chains.size());  // each has two
  EXPECT_LT(plan.points.size(), plan.legs.size());
  const auto any_chain = [&](auto is) { return std::any_of(plan.chains.begin(), plan.chains.end(), is); };
  EXPECT_TRUE(any_chain([](const SharedLegPlan::ChainPath& chain) { return chain.is_reversed; }));
  EXPECT_TRUE(any_chain([](const SharedLegPlan::ChainPath& chain) { return chain.inner == SharedLegPlan::kNone; }));
  EXPECT_TRUE(any_chain([&](const SharedLegPlan::ChainPath& chain) {
    return chain.inner != SharedLegPlan::kNone && (plan.inner[chain.inner].diffuse & 1) == 0;
  }));
  EXPECT_TRUE(
      any_chain([&](const SharedLegPlan::ChainPath& chain) { return plan.images[plan.legs[chain.end].image].parent != 0; }));
  EXPECT_GT(plan.inner.size(), 10u);
}

}  // namespace
}  // namespace echopath::test_shared_legs
