// Paths put together from the legs that they share are those that are evaluated one by one.
#include <gtest/gtest.h>

#include "cpp/replay/legs/all_kinds_of_paths.h"
#include "cpp/replay/small_arrays.h"
#include "cpp/support/path_by_path.h"
#include "echopath/base/constants.h"
#include "echopath/replay/evaluate/path_evaluator.h"
#include "echopath/replay/posed/touched_meshes.h"

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

TEST(SharedLegs, PathsThatAreAskedForTwiceAreEvaluatedTwice) {
  const Radar radar = array_of_powers();
  const Paths paths = record(radar);
  std::vector<int64_t> twice;
  for (const int64_t path : all_of(paths)) twice.insert(twice.end(), 2, path);
  std::vector<double> once_lengths, lengths;
  std::vector<std::complex<double>> once_amplitudes, amplitudes;
  const Replayer replayer(paths, radar);
  replayer.evaluate(all_of(paths), paths.frame.trace_time, once_lengths, once_amplitudes);
  replayer.evaluate(twice, paths.frame.trace_time, lengths, amplitudes);
  for (size_t at = 0; at < lengths.size(); ++at) {
    ASSERT_NEAR(lengths[at], once_lengths[at / 2], kRounding * lengths[at]);
    ASSERT_LE(std::abs(amplitudes[at] - once_amplitudes[at / 2]), kFilterRounding * std::abs(once_amplitudes[at / 2]));
  }
}

// Of one point, which an antenna sees alike on both ways.
TEST(SharedLegs, UnfilteredAmplitudesAreThoseOfCellsWithoutSize) {
  const Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero(), 0.25);
  const Paths paths = record(radar, false);
  const PathPreparer preparer(paths, touched_meshes(paths));
  RadioConstants radio = radio_constants(paths, radar);
  radio.cells.side = 0.0;
  const SheetPassages sheets(preparer, radar.waveform);
  const std::vector<int64_t> indices = all_of(paths);
  const PosedNodes nodes(
      pose_at(*paths.scene, radar, preparer.meshes(), paths.frame.transmitter, {&paths.frame.trace_time, 1}));
  std::vector<double> lengths(indices.size()), unfiltered(indices.size());
  std::vector<std::complex<double>> amplitudes(indices.size());
  ChannelNodes to{lengths.data(), amplitudes.data(), indices.size(), 0, 1.0};
  for (const bool as_chains : {false, true}) {
    PathEvaluator evaluator;
    evaluator.begin(preparer, radar, sheets, SpecularPoints::kMaterial, as_chains);
    evaluator.plan(indices);
    evaluator.evaluate(nodes, radio, {0, {&to, 1}}, {.unfiltered = unfiltered.data()});
    int num_compared = 0;
    for (size_t p = 0; p < indices.size(); ++p) {
      const bool is_mirrored = preparer.is_image(paths.hits_of(indices[p])->mesh_id, paths.stratum[p]);
      if (paths.diffuse[p] != 0 || paths.num_bounces[p] != 1 || is_mirrored) continue;
      const double of_mirror = 0.25 * radio.wavelength / (4.0 * kPi * lengths[p]);  // what it never exceeds
      EXPECT_NEAR(unfiltered[p] / std::min(of_mirror, std::abs(amplitudes[p])), 1.0, kGrazingRounding);
      ++num_compared;
    }
    EXPECT_GT(num_compared, 100);
  }
}

}  // namespace
}  // namespace echopath::test_shared_legs
