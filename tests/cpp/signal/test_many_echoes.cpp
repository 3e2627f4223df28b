// The NUFFT as it adds many moving echoes: sorted, in tiles, by moments of cells. Truth is the direct sum in double.
#include <gtest/gtest.h>

#include "cpp/signal/crowds.h"
#include "cpp/support/any_threads.h"

namespace echopath::test_many_echoes {
namespace {

using namespace testing;

// Of the direct sum itself: 512 samples of phase, relative to the sum of |a|.
constexpr double kDirectRounding = 1e-12;
constexpr double kAdditivity = 1e-12;
constexpr double kWeakEchoDb = 0.1;

std::vector<Complex> direct_of(const ChirpSequence& w, const Echoes& echoes) {
  return testing::synthesize(w, echoes, {.method = Method::kDirect});
}

double error_against(const std::vector<Complex>& direct, const ChirpSequence& w, const Echoes& echoes, double tolerance) {
  const auto nufft = testing::synthesize(w, echoes, {tolerance, Method::kNufft});
  const std::vector<Complex> first(echoes.amplitude.begin(), echoes.amplitude.begin() + echoes.num_echoes);
  return rms_error(nufft, direct, testing::sum_of_magnitudes(first));
}

TEST(ManyEchoes, NufftHoldsItsToleranceHoweverCrowdedAndMixedTheCellsAre) {
  struct Case {
    int count;
    double from, cells, drift;
  };
  const double middle = 500 * cell_delay(few_chirps());
  for (const Case& c : {Case{1, middle, 1, 0}, Case{9, middle, 1, 0}, Case{300, middle, 0.5, 0}, Case{1500, middle, 5, 0},
                        Case{1500, middle, 5, 3}, Case{700, 1e-9, 1000, 5}, Case{600, middle, 150, 0.3}}) {
    for (const int num_chirps : {2, 7, 19}) {
      const ChirpSequence w = few_chirps(num_chirps);
      const Echoes echoes = crowd(w, c.count, c.from, c.cells, c.drift);
      const auto direct = direct_of(w, echoes);
      for (const double tolerance : {1e-1, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-10, 1e-12}) {
        EXPECT_LT(error_against(direct, w, echoes, tolerance), tolerance + kDirectRounding)
            << c.count << " echoes in " << c.cells << " cells, tolerance " << tolerance << ", chirps " << num_chirps;
      }
    }
  }
}

// Few samples, so that the sum in extended precision is affordable. Echoes of random phase: their errors add up as they do.
TEST(ManyEchoes, AHundredThousandEqualTheSlowSum) {
  ChirpSequence w = few_chirps(1);
  w.num_samples = 16;
  constexpr int kCount = 100'000;
  const Echoes echoes = crowd(w, kCount, 0.5 * cell_delay(w), 30.0, 0.01);
  std::vector<double> delay, rate;
  std::vector<Complex> amplitude;
  for (int p = 0; p < kCount; ++p) {
    const double first = echoes.delay[p], last = echoes.delay[p + kCount];
    delay.push_back(0.5 * (first + last));
    rate.push_back((last - first) / w.chirp_interval);
    amplitude.push_back(0.5 * (echoes.amplitude[p] + echoes.amplitude[p + kCount]));
  }
  const auto expected = testing::slow_chirp(w, delay, rate, amplitude);
  const double level = rms_error(expected, std::vector<Complex>(expected.size()), 1.0);
  constexpr double kRounding = 1e-10;  // of delays and slopes between two nodes, as phase
  for (const double tolerance : {1e-3, 1e-7, 1e-9}) {
    const auto made = testing::synthesize(w, echoes, {tolerance, Method::kNufft});
    EXPECT_LT(rms_error(made, expected, level), tolerance + kRounding) << tolerance;
  }
  for (const Method method : {Method::kDirect, Method::kRecurrence}) {
    EXPECT_LT(rms_error(testing::synthesize(w, echoes, {.method = method}), expected, level), kRounding);
  }
}

TEST(ManyEchoes, CellEdgesAndEndsOfTheRangeAreAsGood) {
  const ChirpSequence w = few_chirps();
  std::vector<double> delay;
  for (int cell = 0; cell <= 1024; ++cell) {
    for (const double off : {-1e-12, 0.0, 1e-12}) delay.push_back((cell + off) * cell_delay(w));
    delay.push_back((cell + 0.5) * cell_delay(w));  // where the kernel of an odd width changes its cell
  }
  const std::vector<double> rest(delay.size());
  const Echoes echoes = two_node_echoes(w, delay, rest, std::vector<Complex>(delay.size(), 1.0));
  const auto direct = direct_of(w, echoes);
  for (const double tolerance : {1e-4, 1e-6, 1e-7, 1e-10}) {
    EXPECT_LT(error_against(direct, w, echoes, tolerance), tolerance) << tolerance;
  }
}

// The strong echoes drown the weak one only by the tolerance, which is relative to their sum.
TEST(ManyEchoes, EchoAHundredDecibelsDownKeepsItsLevel) {
  const ChirpSequence w = few_chirps(1);
  Echoes strong = crowd(w, 200, 300 * cell_delay(w), 3, 0);
  for (Complex& a : strong.amplitude) a /= 200.0;
  const Echoes weak = two_node_echoes(w, {700.3 * cell_delay(w)}, {0.0}, {1e-5});
  const SynthesisOptions options{1e-9, Method::kNufft};
  Synthesizer both(w, 1, 1, 201, options);
  both.add(0, strong);
  both.add(0, weak);
  const auto sum = both.cube();
  const auto expected_strong = testing::synthesize(w, strong, {.method = Method::kDirect});
  const auto expected_weak = testing::synthesize(w, weak, {.method = Method::kDirect});
  Complex correlation;
  double energy = 0.0;
  for (size_t i = 0; i < sum.size(); ++i) {
    correlation += (sum[i] - expected_strong[i]) * std::conj(expected_weak[i]);
    energy += std::norm(expected_weak[i]);
  }
  EXPECT_NEAR(20.0 * std::log10(std::abs(correlation) / energy), 0.0, kWeakEchoDb);
}

// Echoes that others before them resemble are sorted on their own all the same.
TEST(ManyEchoes, OrderOfOtherWorkLeavesNoTrace) {
  const ChirpSequence w = few_chirps();
  const Echoes echoes = crowd(w, 900, 400 * cell_delay(w), 40, 1);
  Echoes others = echoes;
  for (size_t p = 0; p < others.delay.size(); ++p)
    others.delay[p] += (static_cast<double>(p % 3) - 1.0) * 0.8 * cell_delay(w);
  const SynthesisOptions options{1e-9, Method::kNufft};
  const auto expected = testing::synthesize(w, echoes, options);
  testing::synthesize(w, others, options);
  EXPECT_EQ(testing::synthesize(w, echoes, options), expected);
}

// tau = a + b x + c x^2 through three nodes, x the share of the frame: each chirp has a rate of its own.
TEST(ManyEchoes, AcceleratingEchoesHaveTheRateOfEachChirp) {
  ChirpSequence w = few_chirps();
  w.num_samples = 64;
  constexpr int kCount = 500;
  constexpr double kTolerance = 1e-9, kRounding = 1e-10;  // of slopes between nodes, as phase
  const double span = w.num_chirps * w.chirp_interval;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<double> start, drift, bend;
  for (int p = 0; p < kCount; ++p) {
    start.push_back((30.0 + 5.0 * unit(random)) * cell_delay(w));
    drift.push_back(1e-11 * unit(random));
    bend.push_back(2e-11 * unit(random));  // s: the beat frequency changes by 3 % of a cell from chirp to chirp
  }
  const std::vector<Complex> amplitude(kCount, {0.6, -0.8});
  Echoes echoes;
  echoes.num_echoes = kCount;
  echoes.sampling.num_rows = echoes.sampling.order = 3;
  echoes.sampling.first_row.assign(w.num_chirps, 0);
  for (const double x : {0.0, 0.5, 1.0}) {
    for (int p = 0; p < kCount; ++p) echoes.delay.push_back(start[p] + x * (drift[p] + x * bend[p]));
    echoes.amplitude.insert(echoes.amplitude.end(), amplitude.begin(), amplitude.end());
  }
  std::vector<Complex> expected;
  for (int j = 0; j < w.num_chirps; ++j) {
    const double x = (j + 0.5) / w.num_chirps;
    const double values[] = {2 * (x - 0.5) * (x - 1), 4 * x * (1 - x), 2 * x * (x - 0.5)};  // Lagrange's polynomials
    const double slopes[] = {4 * x - 3, 4 - 8 * x, 4 * x - 1};
    for (const double value : values) echoes.sampling.value.push_back(value);
    for (const double slope : slopes) echoes.sampling.slope.push_back(slope / span);
    std::vector<double> delay, rate;
    for (int p = 0; p < kCount; ++p) {
      delay.push_back(start[p] + x * (drift[p] + x * bend[p]));
      rate.push_back((drift[p] + 2 * x * bend[p]) / span);
    }
    const auto chirp = testing::slow_chirp(w, delay, rate, amplitude);
    expected.insert(expected.end(), chirp.begin(), chirp.end());
  }
  for (const Method method : {Method::kNufft, Method::kDirect, Method::kRecurrence}) {
    EXPECT_LT(rms_error(testing::synthesize(w, echoes, {kTolerance, method}), expected, kCount), kTolerance + kRounding);
  }
}

TEST(ManyEchoes, BlocksAtOnceEqualBlocksOneByOne) {
  const ChirpSequence w = few_chirps();
  const std::vector<Echoes> blocks = {crowd(w, 900, 400 * cell_delay(w), 12, 1), crowd(w, 500, 405 * cell_delay(w), 12, 1),
                                      testing::static_echoes(w.num_chirps, {1e-7, 2e-7}, {1.0, 0.5}),
                                      crowd(w, 70, 390 * cell_delay(w), 2, 0)};
  Synthesizer at_once(w, 1, 1, 1472, {.method = Method::kNufft}), one_by_one(w, 1, 1, 1472, {.method = Method::kNufft});
  at_once.add(0, blocks);
  for (const Echoes& block : blocks) one_by_one.add(0, block);
  EXPECT_LT(testing::largest_difference(at_once.cube(), one_by_one.cube()), kAdditivity * 1472);
}

TEST(ManyEchoes, SameBitsForAnyNumberOfThreads) {
  const ChirpSequence w = few_chirps(41);
  const std::vector<Echoes> moving = {crowd(w, 2000, 400 * cell_delay(w), 12, 4),
                                      crowd(w, 2000, 405 * cell_delay(w), 300, 1)};
  Echoes still = testing::static_echoes(w.num_chirps, moving[1].delay, moving[1].amplitude);
  still.num_echoes = 4000;
  const auto cube = [&] {
    Synthesizer synthesizer(w, 1, 1, 8000);
    synthesizer.add(0, moving);
    synthesizer.add(0, still);
    return synthesizer.cube();
  };
  test::same_on_any_threads(cube, {2, 5});
}

}  // namespace
}  // namespace echopath::test_many_echoes
