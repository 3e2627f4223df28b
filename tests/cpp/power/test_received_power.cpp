// Received power and its standard error: against closed forms and against the spread of many independent traces.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <tuple>

#include "cpp/support/expect_error.h"
#include "cpp/support/sanitized.h"
#include "cpp/support/scenes.h"
#include "echopath/power/faint_paths.h"
#include "echopath/power/received_power.h"

namespace echopath::test_received_power {
namespace {

using namespace testing;

constexpr int kSeeds = 400;
// relative: the spread of 400 values is known to 4 %, heavy tails to a few times that
constexpr double kErrorOfErrors = 0.15;
constexpr double kFourSigma = 4.0;
constexpr double kPlateDb = 0.1;   // the promise for a plate
constexpr double kGhostDb = 0.05;  // of families of ghosts
constexpr double kImage = 1e-6;    // relative: single precision of weights
constexpr double kRounding = 1e-12;
constexpr double kErrorsShow = 1e-4;  // relative: a filter that is at work
// relative: two thousand echoes of a sphere, of which a few stand, summed in another order
constexpr double kCancelled = 1e-11;
constexpr char kStatistics[] = "statistics of 400 traces, of code that the tests below run, too";

Paths shot(const Scene& scene, const Radar& radar, int64_t num_rays, uint64_t seed, int batches,
           Footprint footprint = Footprint::kSecondOrder, int max_bounces = 4) {
  TraceSettings settings = with_rays(num_rays, max_bounces);
  settings.seed = seed;
  settings.batches = batches;
  settings.footprint = footprint;
  return trace(scene, radar, settings);
}

Scene metal_sphere() {
  Scene scene;
  add_smooth_ball(scene, "ball", {10, 0, 0}, 0.1, 3);
  return scene;
}

// 0.1 m, turned by 3 degrees: cos^2 sinc^2 gives -0.980 dBsm.
constexpr double kTiltedPlate = -0.980;
Scene tilted_plate() {
  const Vec3 edge = 0.1 * Vec3(std::sin(kPi / 60.0), std::cos(kPi / 60.0), 0.0), up(0, 0, 0.1);
  Scene scene;
  add_rectangle(scene, "plate", Vec3(10, 0, 0) - 0.5 * (edge + up), edge, up, share(Material::metal()));
  return scene;
}

Scene lambert_plate() {
  Scene scene;
  add_rectangle(scene, "plate", {20, -0.5, -0.5}, {0, 1, 0}, {0, 0, 1}, lambert(0.3));
  return scene;
}

struct Spread {
  double mean_power = 0.0, spread = 0.0, rms_error = 0.0;
};

Spread spread_of(const Scene& scene, const Radar& radar, int64_t num_rays, Footprint footprint = Footprint::kSecondOrder) {
  std::vector<double> powers;
  Spread out;
  for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const ReceivedPower power = received_power(shot(scene, radar, num_rays, seed, 8, footprint, 1));
    powers.push_back(power.power);
    out.rms_error += power.standard_error * power.standard_error / kSeeds;
  }
  out.rms_error = std::sqrt(out.rms_error);
  out.mean_power = std::accumulate(powers.begin(), powers.end(), 0.0) / kSeeds;
  for (const double power : powers) out.spread += (power - out.mean_power) * (power - out.mean_power) / (kSeeds - 1);
  out.spread = std::sqrt(out.spread);
  return out;
}

TEST(ReceivedPower, ErrorOfACoherentEchoIsItsSpread) {
  if (test::kIsSanitized) GTEST_SKIP() << kStatistics;
  const Spread sphere = spread_of(metal_sphere(), plain_radar(Vec3::Zero(), Vec3::Zero()), 2048);
  EXPECT_LT(sphere.spread / sphere.mean_power, 0.01);
  EXPECT_NEAR(sphere.rms_error / sphere.spread, 1.0, kErrorOfErrors);
}

// Off the main lobe of a plate the error is that of its edges, and lies along the field.
TEST(ReceivedPower, ErrorOfATiltedPlateIsItsSpread) {
  if (test::kIsSanitized) GTEST_SKIP() << kStatistics;
  const Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero());
  const Spread plate = spread_of(tilted_plate(), radar, 4096);
  EXPECT_NEAR(plate.rms_error / plate.spread, 1.0, kErrorOfErrors);
  EXPECT_NEAR(decibel(rcs_of(plate.mean_power, 10.0, radar.waveform.start_frequency)), kTiltedPlate, kPlateDb);
}

TEST(ReceivedPower, ErrorOfADiffuseEchoIsItsSpread) {
  if (test::kIsSanitized) GTEST_SKIP() << kStatistics;
  const Spread plate = spread_of(lambert_plate(), plain_radar(Vec3::Zero(), Vec3::Zero()), 2048);
  EXPECT_NEAR(plate.rms_error / plate.spread, 1.0, kErrorOfErrors);
}

// Without the filter and with few rays the field is mostly noise: |mean|^2 is far too high, the estimate is not.
TEST(ReceivedPower, HasNoBiasWhereTheFieldIsNoise) {
  if (test::kIsSanitized) GTEST_SKIP() << kStatistics;
  const Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero());
  const Spread noisy = spread_of(metal_sphere(), radar, 2048, Footprint::kNone);
  const double truth = std::norm(coherent_sum(shot(metal_sphere(), radar, 1 << 19, 1, 1, Footprint::kNone, 1)));
  EXPECT_NEAR(noisy.mean_power, truth, kFourSigma * noisy.spread / std::sqrt(kSeeds));
  EXPECT_GT(noisy.spread, truth);
  // On the safe side: noise feigns some field for its own error to act upon.
  EXPECT_GT(noisy.rms_error / noisy.spread, 1.0 - kErrorOfErrors);
  EXPECT_LT(noisy.rms_error / noisy.spread, 1.4 + kErrorOfErrors);
  double biased = 0.0;
  for (uint64_t seed = 1; seed <= 50; ++seed) {
    biased += std::norm(coherent_sum(shot(metal_sphere(), radar, 2048, seed, 8, Footprint::kNone, 1))) / 50;
  }
  EXPECT_GT(biased, 2.0 * truth);
}

// sigma = rho A^2-integral of a Lambert plate of 1 m^2 at 20 m: 1.1985 m^2 for rho = 0.3.
TEST(ReceivedPower, OfALambertPlateIsItsMeanLevel) {
  const Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero());
  const ReceivedPower power = received_power(shot(lambert_plate(), radar, 20000, 1, 8));
  EXPECT_TRUE(power.resolved());
  EXPECT_EQ(power.coherent, 0.0);
  EXPECT_NEAR(rcs_of(power.power, 20.0, radar.waveform.start_frequency), 1.1985, 0.005);
  EXPECT_LT(power.standard_error, 0.01 * power.power);
}

// A Lambert sphere beside a metal wall: both orders of the one-way ghost share their phase and add as fields between
// antennas at one place (power ratios to the direct echo by quadrature).
TEST(ReceivedPower, OrdersOverAMirrorAddAsFields) {
  Scene scene;
  Surface ball = ellipsoid({10, 0, 1}, {0.3, 0.3, 0.3}, 4);
  add_mesh(scene, "ball", std::move(ball.vertices), std::move(ball.triangles), lambert(1.0));
  add_rectangle(scene, "wall", {-20, 3, -10}, {60, 0, 0}, {0, 0, 22}, share(Material::metal(true)));
  const Paths paths = shot(scene, plain_radar({0, 0, 1}, {0, 0, 1}), 100000, 1, 8);
  const auto of_bounces = [&](int count) {
    std::vector<uint8_t> keep;
    for (size_t i = 0; i < paths.offsets.size(); ++i) {
      keep.push_back(paths.num_bounces[i] == count && std::has_single_bit(paths.diffuse[i]));
    }
    return received_power(paths.select(keep));
  };
  const ReceivedPower direct = of_bounces(1), pair = of_bounces(2), two_way = of_bounces(3);
  EXPECT_NEAR(decibel(pair.power / direct.power), 4.053, kGhostDb);
  EXPECT_NEAR(decibel(two_way.power / direct.power), -2.700, kGhostDb);
  // Paths of the wall alone are known without rays: no error comes from them.
  std::vector<uint8_t> images;
  for (const uint8_t batch : paths.batch) images.push_back(batch == kNoBatch);
  const ReceivedPower wall = received_power(paths.select(images));
  const double image_field = kSpeedOfLight / 77e9 / (4 * kPi * 6.0);
  EXPECT_NEAR(wall.power / (image_field * image_field), 1.0, kImage);
  EXPECT_LT(wall.standard_error, 1e-9 * wall.power);
}

TEST(ReceivedPower, PartsOfDiffusePowerAddUp) {
  Scene scene = lambert_plate();
  add_rectangle(scene, "other", {15, 2, -0.5}, {0, 1, 0}, {0, 0, 1}, lambert(0.7));
  const Paths paths = shot(scene, plain_radar(Vec3::Zero(), {0, 0.1, 0}), 20000, 1, 4);
  std::vector<uint8_t> first, second;
  for (int64_t i = 0; i < paths.num_paths(); ++i) {
    first.push_back(paths.hits_of(i)[0].mesh_id == 0);
    second.push_back(!first.back());
  }
  const double sum = received_power(paths.select(first)).power + received_power(paths.select(second)).power;
  EXPECT_NEAR(sum / received_power(paths).power, 1.0, kRounding);
}

// The sum over all paths is the whole echo for any number of batches: what differs is the error of each lattice.
TEST(ReceivedPower, BatchesMakeOneEcho) {
  const Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero());
  const auto level = [&](double power) { return decibel(rcs_of(power, 10.0, radar.waveform.start_frequency)); };
  for (const int batches : {1, 2, 8, 64}) {
    const Paths paths = shot(tilted_plate(), radar, 1 << 16, 2, batches);
    EXPECT_EQ(paths.frame.statistics.num_rays, 1 << 16);
    EXPECT_NEAR(level(std::norm(coherent_sum(paths))), kTiltedPlate, kPlateDb) << batches;
    EXPECT_NEAR(level(received_power(paths).power), kTiltedPlate, kPlateDb) << batches;
  }
}

// Batches alone give standard errors; the interval of one batch is made of what its record shows.
TEST(ReceivedPower, OfOneBatchHasAnInterval) {
  const Paths paths = shot(metal_sphere(), plain_radar(Vec3::Zero(), Vec3::Zero()), 2000, 1, 1);
  const ReceivedPower power = received_power(paths);
  EXPECT_NEAR(power.power / std::norm(coherent_sum(paths)), 1.0, kCancelled);
  EXPECT_TRUE(std::isnan(power.standard_error));
  EXPECT_GT(power.power, power.low);
  EXPECT_LT(power.power, power.high);
  EXPECT_TRUE(power.resolved());
}

// A Gaussian of the phase across the cell: twice its area squares it, so that |F of half density| |no filter| = |F|^2 per
// path.
TEST(ReceivedPower, HalfDensitySquaresAGaussianFilter) {
  const Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero());
  const Paths paths = shot(tilted_plate(), radar, 4096, 1, 1, Footprint::kFirstOrder, 1);
  std::vector<uint32_t> alone(static_cast<size_t>(paths.num_paths()));
  std::iota(alone.begin(), alone.end(), 0);
  const std::vector<ReceivedPower> powers = received_powers(paths, Sorting{alone, alone.size()});
  ASSERT_GT(powers.size(), 100u);
  for (const ReceivedPower& power : powers) {
    EXPECT_LT(power.power, (1.0 - kErrorsShow) * power.unfiltered);
    EXPECT_NEAR(std::abs(power.half_density_field) * std::sqrt(power.unfiltered) / power.power, 1.0, kRounding);
  }
}

TEST(ReceivedPower, OfGroupsIsThatOfSelectionsToTheLastBit) {
  const Scene scene = [] {
    Scene both = metal_sphere();
    add_rectangle(both, "rough", {8, 0.5, -0.5}, {0, 1, 0}, {0, 0, 1}, lambert(0.5));
    add_rectangle(both, "wall", {-5, 3, -5}, {30, 0, 0}, {0, 0, 10}, share(Material::metal(true)));
    return both;
  }();
  for (const int batches : {1, 4}) {
    const Paths paths = shot(scene, plain_radar(Vec3::Zero(), Vec3(0, 0.01, 0)), 4000, 1, batches);
    std::vector<uint32_t> group(static_cast<size_t>(paths.num_paths()));
    for (size_t p = 0; p < group.size(); ++p)
      group[p] = (paths.hits_of(static_cast<int64_t>(p))->mesh_id + paths.num_bounces[p]) % 3;
    const std::vector<uint32_t> together(group.size());
    const Sorting sortings[] = {{together, 1}, {group, 4}};
    const std::vector<ReceivedPower> powers = received_powers(paths, sortings).back();
    for (uint32_t g = 0; g < 4; ++g) {
      std::vector<uint8_t> keep;
      for (const uint32_t of_path : group) keep.push_back(of_path == g);
      const ReceivedPower alone = received_power(paths.select(keep));
      EXPECT_EQ(powers[g].num_coherent_paths + powers[g].num_diffuse_hits == 0, g == 3);
      EXPECT_EQ(powers[g].power, alone.power);
      EXPECT_EQ(powers[g].low, alone.low);
      EXPECT_EQ(powers[g].high, alone.high);
      EXPECT_EQ(powers[g].half_density_field, alone.half_density_field);
      EXPECT_EQ(powers[g].unfiltered, alone.unfiltered);
      EXPECT_EQ(powers[g].between_rays, alone.between_rays);
    }
  }
  EXPECT_THROW(received_powers(shot(scene, plain_radar(Vec3::Zero(), Vec3::Zero()), 100, 1, 1), Sorting{{}, 1}),
               std::invalid_argument);
}

// The sidelobe of a plate at 20 degrees is filtered away by 2048 rays, in all batches alike: its interval says so.
TEST(ReceivedPower, IntervalHoldsWhatTheFilterTakesAway) {
  const Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero());
  const double truth = received_power(shot(metal_sphere(), radar, 1 << 17, 1, 1)).power;
  const ReceivedPower coarse = received_power(shot(metal_sphere(), radar, 64, 1, 4));
  EXPECT_GT(std::abs(coarse.power - truth), 4.0 * coarse.standard_error);
  EXPECT_LT(coarse.low, truth);
  EXPECT_GT(coarse.high, truth);
  EXPECT_FALSE(coarse.resolved());
}

// Directions at random err by the root of the sum of squares, and so do all hits behind a diffuse one: the fields of all
// paths over the same hits, in either order, are one hit.
TEST(ReceivedPower, ErrorOfWhatChanceFindsIsTheRootOfTheSumOfSquares) {
  Scene scene = lambert_plate();
  add_rectangle(scene, "floor", {5, -3, -1}, {30, 0, 0}, {0, 6, 0}, lambert(0.8));
  for (const Sampler sampler : {Sampler::kRandom, Sampler::kLattice}) {
    TraceSettings settings = with_rays(4000, 2);
    settings.sampler = sampler;
    const Paths all = trace(scene, plain_radar(Vec3::Zero(), Vec3::Zero()), settings);
    const int least = sampler == Sampler::kRandom ? 1 : 2;
    std::vector<uint8_t> keep;
    for (const uint64_t diffuse : all.diffuse) keep.push_back(std::popcount(diffuse) >= least);
    const Paths paths = all.select(keep);
    std::map<std::vector<std::tuple<uint32_t, uint32_t, float, float>>, std::complex<double>> fields;  // by hits, in order
    const Replayed replay = replayed(paths);
    const double wavenumber = kTwoPi * paths.radar.waveform.start_frequency / kSpeedOfLight;
    for (size_t i = 0; i < replay.lengths.size(); ++i) {
      std::vector<std::tuple<uint32_t, uint32_t, float, float>> hits;
      for (int k = 0; k < paths.num_bounces[i]; ++k) {
        const Hit& hit = paths.hits_of(static_cast<int64_t>(i))[k];
        hits.emplace_back(hit.mesh_id, hit.triangle_id, hit.u, hit.v);
      }
      std::ranges::sort(hits);
      fields[hits] += replay.amplitudes[i] * std::polar(1.0, -std::fmod(wavenumber * replay.lengths[i], kTwoPi));
    }
    double sum = 0.0, squares = 0.0;
    for (const auto& [hits, field] : fields) {
      sum += std::norm(field);
      squares += std::norm(field) * std::norm(field);
    }
    const ReceivedPower power = received_power(paths);
    EXPECT_GT(fields.size(), 100u);
    EXPECT_NEAR(power.power / sum, 1.0, kCancelled);
    EXPECT_NEAR(power.chance / std::sqrt(squares), 1.0, kCancelled) << least;
  }
}

// Likewise of paths that a lot has kept for others, though a lattice has found them: each counts for 64.
TEST(ReceivedPower, ErrorOfWhatStandsForOthersIsTheRootOfTheSumOfSquares) {
  Paths paths = shot(lambert_plate(), plain_radar(Vec3::Zero(), Vec3::Zero()), 40000, 1, 1);
  paths.frame.faint_power = 1.0;
  const Paths some = thinned(paths);
  double squares = 0.0;
  for (const std::complex<double>& amplitude : replayed(some).amplitudes) squares += std::pow(std::norm(amplitude), 2);
  EXPECT_GT(some.num_paths(), 100);
  EXPECT_LT(some.num_paths(), paths.num_paths() / 32);
  EXPECT_NEAR(received_power(some).chance / std::sqrt(squares), 1.0, kRounding);
}

// The echo of a hit over a faint mirror is drawn, that without it is there for certain: so the power of the hit errs by what
// both of them make together, the mean square over all phases between them.
TEST(GroupSums, TellWhatStandsForOthersBesideWhatIsThereForCertain) {
  Scene scene = lambert_plate();
  Material glass;
  glass.permittivity = 2.0;
  glass.mirror = true;
  add_rectangle(scene, "floor", {0, -5, -10}, {25, 0, 0}, {0, 10, 0}, share(glass));
  const Paths all = shot(scene, plain_radar(Vec3::Zero(), Vec3::Zero()), 40000, 1, 1);
  std::vector<uint8_t> keep;
  for (const uint64_t diffuse : all.diffuse) keep.push_back(diffuse != 0);
  Paths paths = all.select(keep);
  for (const std::complex<double>& amplitude : replayed(paths).amplitudes)
    paths.frame.faint_power = std::max(paths.frame.faint_power, 0.3 * std::norm(amplitude));
  const Paths some = thinned(paths);
  std::map<std::tuple<uint32_t, float, float>, std::array<std::complex<double>, 2>> fields;  // for certain, and drawn
  const Replayed replay = replayed(some);
  const double wavenumber = kTwoPi * some.radar.waveform.start_frequency / kSpeedOfLight;
  for (size_t i = 0; i < replay.lengths.size(); ++i) {
    const Hit& hit = some.hits_of(static_cast<int64_t>(i))[std::countr_zero(some.diffuse[i])];
    const bool is_drawn = (some.flags[i] & kStandsForOthers) != 0;
    EXPECT_EQ(is_drawn, some.num_bounces[i] > 1);
    fields[{hit.triangle_id, hit.u, hit.v}][is_drawn ? 1 : 0] +=
        replay.amplitudes[i] * std::polar(1.0, -std::fmod(wavenumber * replay.lengths[i], kTwoPi));
  }
  double squares = 0.0, of_drawn_alone = 0.0;
  for (const auto& [hit, field] : fields) {
    of_drawn_alone += std::pow(std::norm(field[1]), 2);
    for (const double turn : {0.0, 0.25, 0.5, 0.75})
      squares += 0.25 * std::pow(std::norm(field[0] + std::polar(1.0, kTwoPi * turn) * field[1]) - std::norm(field[0]), 2);
  }
  EXPECT_GT(squares, 2.0 * of_drawn_alone);
  const std::vector<uint32_t> together(static_cast<size_t>(some.num_paths()));
  const Sorting sorting{together, 1};
  const GroupSums sums = sum_groups(some, some.radar, {&sorting, 1}, nullptr, nullptr).front().front();
  EXPECT_NEAR(sums.drawn_squares / squares, 1.0, kCancelled);
}

// By the image method: lambda / (4 pi L) over the way of 20 m, times the gain of half of both antennas and the root of 9 W.
TEST(GroupSums, KnowWhatAnEndlessMirrorWouldSendBack) {
  Scene scene;
  add_rectangle(scene, "plate", {10, -0.2, -0.2}, {0, 0.4, 0}, {0, 0, 0.4}, share(Material::metal()));
  const Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero(), 0.5, 9.0);
  const Paths paths = shot(scene, radar, 4096, 1, 1);
  const std::vector<uint32_t> together(static_cast<size_t>(paths.num_paths()));
  const Sorting sorting{together, 1};
  const GroupSums sums = sum_groups(paths, radar, {&sorting, 1}, nullptr, nullptr).front().front();
  ASSERT_EQ(sums.kinds.size(), 1u);
  const double image = 3.0 * 0.5 * kSpeedOfLight / 77e9 / (4.0 * kPi * 20.0);
  constexpr double kBesideTheFoot = 1e-4;  // relative, of the way over the path next to the foot
  EXPECT_NEAR(sums.kinds[0].image_field / image, 1.0, kBesideTheFoot);
}

// Without a filter nothing bounds the phases between the rays: all may be in phase, or cancel.
TEST(ReceivedPower, WithoutAFilterLiesBetweenNothingAndAllInPhase) {
  const Paths paths = shot(metal_sphere(), plain_radar(Vec3::Zero(), Vec3::Zero()), 2048, 1, 1, Footprint::kNone, 1);
  double sum = 0.0;
  for (const std::complex<double>& amplitude : replayed(paths).amplitudes) sum += std::abs(amplitude);
  const ReceivedPower power = received_power(paths);
  EXPECT_NEAR((power.bias + power.power) / (sum * sum), 1.0, kRounding);
  EXPECT_GE(power.high, sum * sum);
  EXPECT_EQ(power.low, 0.0);
}

// Of half the power 3.01 dB, of twice it as much; of 5 / 4 of it 0.969 dB.
TEST(ReceivedPower, TellsItsIntervalAndErrorInDecibels) {
  ReceivedPower power;
  power.power = 2.0, power.low = 1.0, power.high = 2.5;
  EXPECT_NEAR(power.interval_db(), 10.0 * std::log10(2.0), kRounding);
  EXPECT_FALSE(power.is_within(3.0));
  EXPECT_TRUE(power.is_within(3.02));
  power.low = 1.9;
  EXPECT_NEAR(power.interval_db(), 10.0 * std::log10(1.25), kRounding);
  EXPECT_FALSE(power.is_within(0.96));
  EXPECT_TRUE(power.is_within(0.98));
  power.low = 0.0;
  EXPECT_EQ(power.interval_db(), INFINITY);
  power.standard_error = 0.5;
  EXPECT_NEAR(power.error_db(), 10.0 * std::log10(1.25), kRounding);
  power.standard_error = 1.01;  // more than half of the power
  EXPECT_EQ(power.error_db(), INFINITY);
  power.standard_error = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(power.error_db(), INFINITY);
}

// A metal ball beside a rough plate, of which each hit makes one path.
TEST(ReceivedPower, KnowsEachPathAndTheStrongestHit) {
  Scene scene = metal_sphere();
  add_rectangle(scene, "rough", {8, 0.5, -0.5}, {0, 1, 0}, {0, 0, 1}, lambert(0.5));
  const Paths paths = shot(scene, plain_radar(Vec3::Zero(), Vec3(0, 0.01, 0)), 4000, 1, 1, Footprint::kSecondOrder, 1);
  const std::vector<uint32_t> together(static_cast<size_t>(paths.num_paths()));
  const Sorting sorting{together, 1};
  PowerAndLength of_paths;
  const ReceivedPower power = received_powers(paths, {&sorting, 1}, nullptr, {}, &of_paths).front().front();
  const Replayed replay = replayed(paths);
  double strongest = 0.0, sum = 0.0;
  for (size_t i = 0; i < replay.lengths.size(); ++i) {
    const double of_path = std::norm(replay.amplitudes[i]);
    EXPECT_NEAR(of_paths.power[i], of_path, kRounding * of_path) << i;
    EXPECT_NEAR(of_paths.length[i], replay.lengths[i], kRounding) << i;
    if (paths.diffuse[i] == 0) continue;
    strongest = std::max(strongest, of_path);
    sum += of_path;
  }
  EXPECT_GT(power.coherent, 1e-3 * power.diffuse);  // so that it is told apart
  EXPECT_NEAR(power.strongest_share / (strongest / sum), 1.0, kRounding);
}

TEST(ReceivedPower, IsThatOfAnAntennaThatIsThere) {
  const Paths paths = shot(lambert_plate(), plain_radar(Vec3::Zero(), Vec3::Zero()), 100, 1, 1);
  const auto expect_refused = [&](Channel channel, const std::string& text) {
    test::expect_error<std::out_of_range>([&] { received_power(paths, nullptr, channel); }, {text});
  };
  expect_refused({-1, 0}, "tx: must lie in 0 to 0, got -1");
  expect_refused({1, 0}, "tx: must lie in 0 to 0, got 1");
  expect_refused({0, -1}, "rx: must lie in 0 to 0, got -1");
  expect_refused({0, 1}, "rx: must lie in 0 to 0, got 1");
  const std::vector<uint32_t> beyond(static_cast<size_t>(paths.num_paths()), 1);
  EXPECT_THROW(received_powers(paths, Sorting{beyond, 1}), std::invalid_argument);
}

TEST(ReceivedPower, OfNothingIsZero) {
  const ReceivedPower power = received_power(shot(Scene(), plain_radar(Vec3::Zero(), Vec3::Zero()), 100, 1, 4));
  EXPECT_EQ(power.power, 0.0);
  EXPECT_EQ(power.standard_error, 0.0);
  EXPECT_FALSE(power.resolved());
}

}  // namespace
}  // namespace echopath::test_received_power
