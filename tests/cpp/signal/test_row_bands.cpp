#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "cpp/signal/slow_sum.h"
#include "echopath/signal/echoes/row_bands.h"

namespace echopath::test_row_bands {
namespace {

using testing::Complex;

constexpr int64_t kLength = 200;
constexpr int kChirps = 3;
constexpr double kRounding = 1e-12;  // relative to the sum of |a|: order of additions only

using Dense = std::vector<double>;  // [chirp, re/im, kLength]

// Adds random numbers to some cells of a row.
void add_some(RowBands& bands, size_t row, std::mt19937_64& random, Dense& dense) {
  const auto first = static_cast<int64_t>(random() % (kLength - 20)), end = first + 1 + static_cast<int64_t>(random() % 20);
  const TileRows rows = bands.room(row, {first, end});
  for (int64_t part = 0; part < 2 * kChirps; ++part) {
    double* const to = rows.rows + part / 2 * rows.chirp_stride + part % 2 * rows.row_length;
    for (int64_t cell = first; cell < end; ++cell) {
      const double value = static_cast<double>(random() % 1000);
      to[cell] += value;
      dense[static_cast<size_t>(part * kLength + cell)] += value;
    }
  }
}

Dense dense_row(const RowBands& bands, size_t row) {
  Dense dense(2 * kChirps * kLength);
  for (int chirp = 0; chirp < kChirps; ++chirp) {
    const RowCells cells = bands.cells(row, chirp);
    for (int64_t i = 0; i < cells.count; ++i) {
      dense[static_cast<size_t>(2 * chirp * kLength + cells.first + i)] = cells.re[i];
      dense[static_cast<size_t>((2 * chirp + 1) * kLength + cells.first + i)] = cells.im[i];
    }
  }
  return dense;
}

TEST(RowBands, RowsThatGrowInTurnHoldWhatWasAddedToThem) {
  std::mt19937_64 random(4);
  RowBands bands;
  for (int round = 0; round < 3; ++round) {  // what an earlier round left must not show
    bands.start(1, 5, kChirps, kLength);
    std::vector<Dense> expected(5, Dense(2 * kChirps * kLength));
    for (int i = 0; i < 60; ++i) {
      const size_t row = random() % 4;  // the last one stays empty
      add_some(bands, row, random, expected[row]);
    }
    for (size_t row = 0; row < 5; ++row) EXPECT_EQ(dense_row(bands, row), expected[row]) << row;
    EXPECT_TRUE(bands.has(0));
    EXPECT_FALSE(bands.has(4));
  }
}

// Channels of an array need nearly the same cells: rows take those of the channel before, in the second channel one more on
// either side, so that most never grow. The sums are those of rows that do.
TEST(RowBands, RowsTakeTheCellsOfTheChannelBefore) {
  RowBands bands;
  bands.start(3, 1, kChirps, kLength);
  bands.room(0, {10, 12});
  bands.room(0, {8, 20});
  for (const size_t row : {size_t{1}, size_t{2}}) {
    const TileRows rows = bands.room(row, {15, 16});
    rows.rows[15] += 3.0;
    EXPECT_EQ(bands.cells(row, 0).first, 7);
    EXPECT_EQ(bands.cells(row, 0).count, 14);
    EXPECT_EQ(bands.room(row, {7, 21}).rows, rows.rows);
    Dense expected(2 * kChirps * kLength);
    expected[15] = 3.0;
    EXPECT_EQ(dense_row(bands, row), expected);
  }
}

TEST(RowBands, RowsTakeNoCellsBeyondTheirEnds) {
  RowBands bands;
  bands.start(2, 1, kChirps, kLength);
  bands.room(0, {0, kLength});
  bands.room(1, {15, 16});
  EXPECT_EQ(bands.cells(1, 0).first, 0);
  EXPECT_EQ(bands.cells(1, 0).count, kLength);
}

// A row larger than what memory is handed out in, between small ones.
TEST(RowBands, LongRowsHoldWhatWasAddedToThem) {
  constexpr int64_t kLong = 1 << 17;
  RowBands bands;
  for (int round = 0; round < 2; ++round) {
    bands.start(1, 3, kChirps, kLong);
    bands.room(0, {0, 5}).rows[4] += 1.0;
    bands.room(1, {0, kLong}).rows[kLong - 1] += 2.0;
    bands.room(2, {7, 9}).rows[8] += 3.0;
    bands.room(0, {0, kLong}).rows[6] += 4.0;
    EXPECT_EQ(bands.cells(0, 0).re[4] + bands.cells(0, 0).re[6], 5.0);
    EXPECT_EQ(bands.cells(1, 0).re[kLong - 1], 2.0);
    EXPECT_EQ(bands.cells(2, 0).re[1], 3.0);
    EXPECT_EQ(std::accumulate(bands.cells(0, 0).re, bands.cells(0, kChirps - 1).im + kLong, 0.0), 5.0);
  }
}

ChirpSequence short_frame() {
  ChirpSequence waveform = testing::reference_waveform();
  waveform.num_chirps = 7;  // not a multiple of the chirps of a tile
  return waveform;
}

// Two channels with moving echoes, and echoes at rest in the second.
void add_echoes(const ChirpSequence& waveform, unsigned seed, uint32_t group, Synthesizer& to) {
  const testing::MovingPoints points(90, seed, 5.0 + seed, 20.0 + seed);
  Echoes moving = testing::exact_echoes(waveform, points);
  Echoes still =
      testing::static_echoes(waveform.num_chirps, {moving.delay.begin(), moving.delay.begin() + 90}, points.amplitude);
  for (Echoes* const echoes : {&moving, &still}) echoes->group.assign(90, group);
  for (const int channel : {0, 1}) to.add(channel, moving);
  to.add(1, still);
}

// The signals of each group alone are the truth.
TEST(RowBands, SignalsOfGroupsAddUp) {
  const ChirpSequence waveform = short_frame();
  Synthesizer alone[] = {{waveform, 2, 1, 500}, {waveform, 2, 1, 500}}, parts(waveform, 2, 3, 500);
  for (const unsigned group : {0u, 1u}) {
    add_echoes(waveform, group, 0, alone[group]);
    add_echoes(waveform, group, group, parts);
  }
  ASSERT_TRUE(parts.has_bands() && !alone[0].has_bands());
  const std::vector<Complex> first = alone[0].cube(), second = alone[1].cube();
  EXPECT_EQ(parts.cube(0), first);
  EXPECT_EQ(parts.cube(1), second);
  EXPECT_EQ(parts.cube(2), std::vector<Complex>(first.size()));
  Synthesizer whole(waveform, 2, 1, 500);
  whole.absorb(parts, 2);
  const std::vector<Complex> absorbed = whole.cube();
  std::vector<Complex> samples(first.size() / 2);
  for (const size_t channel : {size_t{0}, size_t{1}}) {
    const std::vector<int> both = {0, 1};
    parts.write_samples(static_cast<int>(channel), both, samples.data());
    for (size_t i = 0; i < samples.size(); ++i) {
      const size_t at = channel * samples.size() + i;
      ASSERT_NEAR(std::abs(absorbed[at] - first[at] - second[at]), 0.0, kRounding * 90) << at;
      ASSERT_NEAR(std::abs(samples[i] - first[at] - second[at]), 0.0, kRounding * 90) << at;
    }
  }
  EXPECT_GT(std::abs(absorbed.front()), 1e-3);
  EXPECT_THROW(parts.absorb(whole, 1), std::invalid_argument);
}

}  // namespace
}  // namespace echopath::test_row_bands
