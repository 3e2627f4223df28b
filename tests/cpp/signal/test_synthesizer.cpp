#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "cpp/signal/slow_sum.h"
#include "cpp/support/any_threads.h"
#include "cpp/support/expect_error.h"
#include "echopath/signal/echoes/echo_states.h"

namespace echopath::test_synthesizer {
namespace {

using testing::Complex;

constexpr Method kMethods[] = {Method::kDirect, Method::kRecurrence, Method::kNufft};
constexpr double kAdditivity = 1e-12;  // relative to the sum of |a|: order of additions only
// Differences of equal delays of 5e-7 s over 60 us leave a rate of 2e-18, which turns the carrier by 1e-11 rad in a
// chirp.
constexpr double kRateRounding = 2e-11;
constexpr double kRounding = 1e-13;

ChirpSequence short_frame(int num_chirps = 13) {
  ChirpSequence w = testing::reference_waveform();
  w.num_chirps = num_chirps;  // not a multiple of the chirps a task owns
  return w;
}

std::vector<uint32_t> round_robin(int count, int num_groups) {
  std::vector<uint32_t> group;
  for (int p = 0; p < count; ++p) group.push_back(p % num_groups);
  return group;
}

TEST(Synthesizer, SameBitsForAnyNumberOfThreads) {
  const ChirpSequence w = short_frame();
  Echoes echoes = testing::exact_echoes(w, testing::MovingPoints(700, 5, 1.0, 70.0));
  echoes.group = round_robin(700, 3);
  for (const Method method : kMethods) {
    const auto cube = [&] {
      Synthesizer synthesizer(w, 1, 3, 700, {.method = method});
      synthesizer.add(0, echoes);
      return synthesizer.cube(1);
    };
    test::same_on_any_threads(cube, {2, 5});
  }
}

TEST(Synthesizer, ChirpsOfAStaticSceneAreBitIdentical) {
  const ChirpSequence w = short_frame();
  for (const Method method : kMethods) {
    const auto cube =
        testing::synthesize(w, testing::static_echoes(w.num_chirps, {1e-7, 2e-7}, {1.0, {0.5, 0.1}}), {.method = method});
    const std::vector<Complex> first(cube.begin(), cube.begin() + w.num_samples);
    EXPECT_GT(std::abs(first[0]), 0.0);
    for (int j = 1; j < w.num_chirps; ++j) {
      EXPECT_TRUE(std::equal(first.begin(), first.end(), cube.begin() + j * w.num_samples)) << j;
    }
  }
}

TEST(Synthesizer, StaticEchoesEqualMovingOnesAtRest) {
  const ChirpSequence w = short_frame();
  testing::MovingPoints points(50, 2, 1.0, 70.0);
  std::fill(points.speed.begin(), points.speed.end(), 0.0);
  Echoes moving = testing::exact_echoes(w, points);
  for (size_t i = 0; i < moving.amplitude.size(); ++i) moving.amplitude[i] = points.amplitude[i % 50];
  const Echoes still =
      testing::static_echoes(w.num_chirps, {moving.delay.begin(), moving.delay.begin() + 50}, points.amplitude);
  for (const Method method : kMethods) {
    const auto difference = testing::largest_difference(testing::synthesize(w, moving, {.method = method}),
                                                        testing::synthesize(w, still, {.method = method}));
    EXPECT_LT(difference, kRateRounding * testing::sum_of_magnitudes(points.amplitude));
  }
}

TEST(Synthesizer, GroupsAddUpToTheWhole) {
  const ChirpSequence w = short_frame();
  const testing::MovingPoints points(301, 5, 1.0, 70.0);
  Echoes echoes = testing::exact_echoes(w, points);
  for (const Method method : {Method::kAuto, Method::kDirect, Method::kRecurrence, Method::kNufft}) {
    echoes.group.clear();
    const auto whole = testing::synthesize(w, echoes, {.method = method});
    echoes.group = round_robin(301, 7);
    Synthesizer parts(w, 1, 7, 301, {.method = method});
    parts.add(0, echoes);
    std::vector<Complex> sum(whole.size());
    for (int g = 0; g < 7; ++g) {
      const auto part = parts.cube(g);
      for (size_t i = 0; i < sum.size(); ++i) sum[i] += part[i];
    }
    const double rounding = kAdditivity * testing::sum_of_magnitudes(points.amplitude);
    EXPECT_LT(testing::largest_difference(sum, whole), rounding);
    Echoes of_third = echoes;
    of_third.group.clear();
    for (size_t i = 0; i < of_third.amplitude.size(); ++i) {
      if (i % 301 % 7 != 3) of_third.amplitude[i] = 0.0;
    }
    EXPECT_LT(testing::largest_difference(parts.cube(3), testing::synthesize(w, of_third, {.method = method})), rounding);
  }
}

// Groups have rows from their first echo on, in memory that other groups used before.
TEST(Synthesizer, GroupsThatComeLateHoldTheirOwnAndNothingElse) {
  const ChirpSequence w = short_frame();
  const testing::MovingPoints early(301, 5, 1.0, 70.0), late(202, 6, 1.0, 70.0);
  Echoes first = testing::exact_echoes(w, early), moving = testing::exact_echoes(w, late);
  Echoes still = testing::static_echoes(w.num_chirps, {moving.delay.begin(), moving.delay.begin() + 202}, late.amplitude);
  for (const Method method : kMethods) {
    const auto alone = [&](const std::vector<Echoes>& blocks) {
      Synthesizer synthesizer(w, 1, 1, 503, {.method = method});
      for (const Echoes& block : blocks) synthesizer.add(0, block);
      return synthesizer.cube();
    };
    const auto of_first = alone({first}), of_both = alone({moving, still}), at_rest = alone({still});
    Synthesizer parts(w, 1, 5, 503, {.method = method});
    for (const auto& [echoes, group] : {std::pair{first, 1u}, {moving, 3u}, {still, 3u}, {still, 0u}}) {
      Echoes block = echoes;
      block.group.assign(static_cast<size_t>(block.num_echoes), group);
      parts.add(0, block);
    }
    EXPECT_EQ(parts.cube(0), at_rest);
    EXPECT_EQ(parts.cube(1), of_first);
    EXPECT_EQ(parts.cube(3), of_both);
    for (const int none : {2, 4}) EXPECT_EQ(parts.cube(none), std::vector<Complex>(of_first.size()));
  }
}

// Chebyshev nodes: the interpolated echo is the polynomial itself, so it must equal exact evaluation at the chirps. From the
// chirp kJump on, it is another polynomial.
TEST(Synthesizer, NodesWithWeightsAreInterpolatedPerChirp) {
  constexpr int kJump = 6;
  const ChirpSequence w = short_frame();
  const auto times = testing::chirp_times(w);
  const double half = 0.5 * times.back();
  const double delay0 = 2e-7, rate = 2e-7;
  Echoes nodes;
  nodes.num_echoes = 1;
  nodes.sampling.num_rows = 4;
  nodes.sampling.order = 2;
  for (int j = 0; j < w.num_chirps; ++j) nodes.sampling.first_row.push_back(j < kJump ? 0 : 2);
  for (const double t : times) {  // linear Lagrange weights for nodes at 0 and `half`
    nodes.sampling.value.insert(nodes.sampling.value.end(), {1.0 - t / half, t / half});
    nodes.sampling.slope.insert(nodes.sampling.slope.end(), {-1.0 / half, 1.0 / half});
  }
  nodes.delay = {delay0, delay0 + rate * half, 2 * delay0, 2 * delay0 + rate * half};
  nodes.amplitude = {{1.0, 0.0}, {0.0, 1.0}, {3.0, 0.0}, {0.0, 3.0}};
  const auto cube = testing::synthesize(w, nodes, {.method = Method::kDirect});
  std::vector<EchoStates> states(w.num_chirps);
  evaluate_states(nodes, 0, w.num_chirps, 0, 1, states.data());
  for (int j = 0; j < w.num_chirps; ++j) {
    const double s = times[j] / half, delay = (j < kJump ? 1 : 2) * delay0 + rate * times[j];
    const Complex amplitude = (j < kJump ? 1.0 : 3.0) * Complex(1.0 - s, s);
    EXPECT_NEAR(states[j].delay[0], delay, kRounding * delay);
    const auto expected = testing::slow_chirp(w, {delay}, {rate}, {amplitude});
    for (int n = 0; n < w.num_samples; ++n) EXPECT_NEAR(std::abs(cube[j * w.num_samples + n] - expected[n]), 0.0, 1e-9);
  }
}

TEST(Synthesizer, ChannelsAreSeparateAndBlocksAddUp) {
  const ChirpSequence w = short_frame();
  const Echoes a = testing::exact_echoes(w, testing::MovingPoints(20, 1, 1.0, 70.0));
  const Echoes b = testing::static_echoes(w.num_chirps, {3e-7}, {0.5});
  Synthesizer synthesizer(w, 2, 1, 20);
  synthesizer.add(1, a);
  synthesizer.add(1, b);
  const auto cube = synthesizer.cube();
  const size_t half = cube.size() / 2;
  for (size_t i = 0; i < half; ++i) EXPECT_EQ(cube[i], Complex());
  auto sum = testing::synthesize(w, a, {.method = Method::kRecurrence});
  const auto still = testing::synthesize(w, b, {.method = Method::kRecurrence});
  for (size_t i = 0; i < half; ++i) EXPECT_NEAR(std::abs(cube[half + i] - sum[i] - still[i]), 0.0, kRounding);
}

TEST(Synthesizer, OnlyGroupsOfChannelsThatGotEchoesHaveThem) {
  const ChirpSequence w = short_frame();
  Echoes moving = testing::exact_echoes(w, testing::MovingPoints(20, 1, 1.0, 70.0));
  Echoes still = testing::static_echoes(w.num_chirps, {3e-7}, {0.5});
  moving.group.assign(20, 0);
  still.group = {1};
  Synthesizer synthesizer(w, 2, 2, 20);
  synthesizer.add(0, still);
  synthesizer.add(1, moving);
  for (const int channel : {0, 1}) {
    for (const int group : {0, 1}) EXPECT_EQ(synthesizer.has_echoes(channel, group), channel != group);
  }
}

// Many at once are shared among parts of all blocks together, few are not.
TEST(Synthesizer, BlocksAtRestAtOnceEqualThoseOneByOne) {
  constexpr int kBlocks = 50, kOfBlock = 301;
  const ChirpSequence w = short_frame();
  Synthesizer at_once(w, 1, 1, kBlocks * kOfBlock), one_by_one(w, 1, 1, kBlocks * kOfBlock);
  std::vector<Echoes> blocks;
  double sum = 0.0;
  for (int b = 0; b < kBlocks; ++b) {
    const testing::MovingPoints points(kOfBlock, static_cast<unsigned>(b), 1.0, 70.0);
    std::vector<double> delay;
    for (const double range : points.range) delay.push_back(range * 2.0 / 299792458.0);
    blocks.push_back(testing::static_echoes(w.num_chirps, delay, points.amplitude));
    one_by_one.add(0, blocks.back());
    sum += testing::sum_of_magnitudes(points.amplitude);
  }
  at_once.add(0, blocks);
  EXPECT_LT(testing::largest_difference(at_once.cube(), one_by_one.cube()), kAdditivity * sum);
}

// A synthesis takes over what another left behind.
TEST(Synthesizer, MemoryOfOthersLeavesNoTrace) {
  const ChirpSequence w = short_frame();
  const testing::MovingPoints few(100, 6, 1.0, 30.0), many(900, 7, 10.0, 70.0);
  const auto synthesized = [&](const testing::MovingPoints& points) {
    return testing::synthesize(w, testing::exact_echoes(w, points), {});
  };
  const auto first = synthesized(few);
  synthesized(many);
  EXPECT_EQ(synthesized(few), first);
}

TEST(Synthesizer, NoEchoesGiveExactZeros) {
  const ChirpSequence w = short_frame();
  for (const Method method : kMethods) {
    Synthesizer synthesizer(w, 2, 2, 0, {.method = method});
    synthesizer.add(0, testing::static_echoes(w.num_chirps, {}, {}));
    const auto cube = synthesizer.cube(1);
    EXPECT_EQ(cube.size(), size_t(2 * w.num_chirps * w.num_samples));
    for (const Complex& sample : cube) EXPECT_EQ(sample, Complex());
  }
}

TEST(Synthesizer, AntiAliasFilterRemovesWhatWouldFold) {
  for (const bool real : {false, true}) {
    ChirpSequence w = short_frame(1);
    w.real = real;
    const double inside = w.max_range() * (1 - 1e-6), outside = w.max_range() * (1 + 1e-6);
    for (const Method method : kMethods) {
      const auto power = [&](double range) {
        const auto cube =
            testing::synthesize(w, testing::static_echoes(1, {2 * range / 299792458.0}, {1.0}), {.method = method});
        double sum = 0.0;
        for (const Complex& sample : cube) sum += std::norm(sample);
        return sum / w.num_samples;
      };
      EXPECT_GT(power(inside), 0.1);  // 1, or 2 cos^2 of the phase for a real tone at half the sampling rate
      EXPECT_EQ(power(outside), 0.0);
      EXPECT_EQ(power(-0.01), 0.0);
      EXPECT_EQ(power(1e200), 0.0);
    }
  }
}

TEST(Synthesizer, RealSamplesAreRootTwoTimesTheRealPart) {
  ChirpSequence w = short_frame();
  const Echoes echoes = testing::exact_echoes(w, testing::MovingPoints(100, 9, 1.0, 30.0));
  const auto complex_cube = testing::synthesize(w, echoes, {});
  w.real = true;
  const auto real_cube = testing::synthesize(w, echoes, {});
  for (size_t i = 0; i < real_cube.size(); ++i) {
    EXPECT_EQ(real_cube[i].imag(), 0.0);
    EXPECT_NEAR(real_cube[i].real(), std::sqrt(2.0) * complex_cube[i].real(), kRounding);
  }
}

TEST(Synthesizer, BadInputIsNamed) {
  const ChirpSequence w = short_frame();
  const Echoes good = testing::exact_echoes(w, testing::MovingPoints(4, 1, 1.0, 70.0));
  const std::vector<std::pair<std::string, std::function<void(Echoes&)>>> cases = {
      {"delay", [](Echoes& e) { e.delay[7] = std::numeric_limits<double>::quiet_NaN(); }},
      {"amplitude", [](Echoes& e) { e.amplitude[3] = {0.0, std::numeric_limits<double>::infinity()}; }},
      {"delay", [](Echoes& e) { e.delay.pop_back(); }},
      {"amplitude", [](Echoes& e) { e.amplitude.pop_back(); }},
      {"group", [](Echoes& e) { e.group = {0, 1}; }},
      {"group", [](Echoes& e) { e.group = {0, 1, 2, 0}; }},
      {"num_echoes", [](Echoes& e) { e.num_echoes = -1; }},
      {"sampling.first_row", [](Echoes& e) { e.sampling.first_row.pop_back(); }},
      {"sampling.first_row", [](Echoes& e) { e.sampling.first_row[0] = 99; }},
      {"sampling.value", [](Echoes& e) { e.sampling.value.clear(); }},
      {"sampling.slope", [](Echoes& e) { e.sampling.slope[0] = std::numeric_limits<double>::infinity(); }},
      {"sampling.order", [](Echoes& e) { e.sampling.order = 0; }},
  };
  for (const auto& [field, spoil] : cases) {
    Echoes echoes = good;
    spoil(echoes);
    Synthesizer synthesizer(w, 1, 2, 4);
    const std::string message = test::error_text([&] { synthesizer.add(0, echoes); });
    EXPECT_TRUE(message.starts_with(field + ": ")) << field << ": " << message;
  }
  EXPECT_THROW(Synthesizer(w, 0, 1, 1), std::invalid_argument);
  EXPECT_THROW(Synthesizer(w, 1, 0, 1), std::invalid_argument);
  EXPECT_THROW(Synthesizer(w, 1, 1, -1), std::invalid_argument);
  EXPECT_THROW(Synthesizer(w, 1, 1, 1, {1e-14}), std::invalid_argument);
  EXPECT_THROW(Synthesizer(w, 1, 1, 1, {0.2}), std::invalid_argument);
  EXPECT_THROW(Synthesizer(w, 1, 1, 1, {std::nan("")}), std::invalid_argument);
  Synthesizer synthesizer(w, 1, 1, 1);
  EXPECT_THROW(synthesizer.add(1, good), std::out_of_range);
  EXPECT_THROW(synthesizer.cube(1), std::out_of_range);
}

TEST(Synthesizer, JobCountsEchoesAndCancels) {
  const ChirpSequence w = short_frame();
  const Echoes echoes = testing::exact_echoes(w, testing::MovingPoints(40, 1, 1.0, 70.0));
  Synthesizer synthesizer(w, 1, 1, 80);
  Job job;
  job.start(80);
  synthesizer.add(0, echoes, &job);
  EXPECT_EQ(job.fraction(), 0.5);
  job.cancel();
  EXPECT_THROW(synthesizer.add(0, echoes, &job), Cancelled);
  EXPECT_THROW(synthesizer.cube(0, &job), Cancelled);
}

}  // namespace
}  // namespace echopath::test_synthesizer
