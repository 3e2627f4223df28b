#include "echopath/label/cells/cells.h"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

#include "cpp/support/any_threads.h"

namespace echopath::test_cells {
namespace {

constexpr double kRounding = 1e-12;  // relative, sums of a few numbers

std::vector<double> random_powers(size_t size) {
  std::mt19937 random(7);
  std::exponential_distribution<double> power(1e12);
  std::vector<double> values(size);
  for (double& value : values) value = power(random);
  return values;
}

// Regions of one label: rows and columns of its cells, in a map of 8 x 5.
LabelRegion region_of(const std::vector<std::pair<int, int>>& cells, bool rows_wrap) {
  const MapShape shape{8, 5, rows_wrap};
  std::vector<int16_t> label(40, kNoLabel);
  std::vector<double> power(40, 1.0);
  for (const auto& [row, column] : cells) label[static_cast<size_t>(row * 5 + column)] = 0;
  return label_regions(label, power, 1, shape).front();
}

TEST(Cells, SharesSumToOneWhereThereIsPower) {
  constexpr int64_t kParts = 5, kCells = 20'000;
  std::vector<double> power = random_powers(kParts * kCells);
  for (int64_t k = 0; k < kParts; ++k) power[static_cast<size_t>(k * kCells + 17)] = 0.0;
  const std::vector<double> share = power_shares(power, kParts);
  for (int64_t i = 0; i < kCells; ++i) {
    double sum = 0.0;
    for (int64_t k = 0; k < kParts; ++k) sum += share[static_cast<size_t>(k * kCells + i)];
    ASSERT_NEAR(sum, i == 17 ? 0.0 : 1.0, kRounding) << i;
  }
  double sum = 0.0;
  for (size_t k = 0; k < kParts; ++k) sum += power[k * kCells];
  EXPECT_NEAR(share[0], power[0] / sum, kRounding);
}

TEST(Cells, MaskNeedsBothTheNoiseFloorAndTheDynamicRange) {
  const std::vector<double> power{100.0, 10.0, 1.0, 0.1, 0.0};
  const CellMask mask = cell_mask(power, 0.5, 0.05);
  EXPECT_EQ(mask.above_noise, (std::vector<uint8_t>{1, 1, 1, 0, 0}));
  EXPECT_EQ(mask.labelled, (std::vector<uint8_t>{1, 1, 0, 0, 0}));
  EXPECT_EQ(cell_mask(power, 0.5, 1.0).labelled, (std::vector<uint8_t>{1, 0, 0, 0, 0}));  // the peak alone
}

TEST(Cells, WithoutNoiseAndLimitEveryCellWithPowerIsLabelled) {
  const CellMask mask = cell_mask(std::vector<double>{1.0, 1e-30, 0.0}, 0.0, 0.0);
  EXPECT_EQ(mask.labelled, (std::vector<uint8_t>{1, 1, 0}));
  EXPECT_TRUE(cell_mask({}, 0.0, 0.0).labelled.empty());
  EXPECT_EQ(cell_mask(std::vector<double>{0.0}, 0.0, 1e-6).labelled, (std::vector<uint8_t>{0}));
}

TEST(Cells, MaskRefusesNegativeLimits) {
  EXPECT_THROW(cell_mask(std::vector<double>{1.0}, -1.0, 0.0), std::invalid_argument);
  EXPECT_THROW(cell_mask(std::vector<double>{1.0}, 0.0, 1.5), std::invalid_argument);
}

TEST(Cells, TheStrongestPartIsTheFirstOfEqualOnesAndOnlyWithinTheMask) {
  const std::vector<double> power{1, 2, 0, 3, /**/ 2, 2, 0, 9};
  const std::vector<uint8_t> labelled{1, 1, 1, 0};
  EXPECT_EQ(strongest_part(power, 2, labelled), (std::vector<int16_t>{1, 0, kNoLabel, kNoLabel}));
  EXPECT_THROW(strongest_part(power, 2, std::vector<uint8_t>{1}), std::invalid_argument);
  EXPECT_THROW(strongest_part(power, 0, labelled), std::invalid_argument);
}

TEST(Cells, ABoxHoldsItsCells) {
  const LabelRegion region = region_of({{2, 3}, {4, 1}, {3, 4}, {5, 2}}, false);
  EXPECT_EQ(region.num_cells, 4);
  EXPECT_EQ(region.first_row, 2);
  EXPECT_EQ(region.last_row, 5);
  EXPECT_EQ(region.first_column, 1);
  EXPECT_EQ(region.last_column, 4);
}

TEST(Cells, ABoxGoesOverTheEndOfFoldingVelocitiesWhereThatIsShorter) {
  const LabelRegion folded = region_of({{0, 2}, {1, 2}, {7, 2}}, true);
  EXPECT_EQ(folded.first_row, 7);
  EXPECT_EQ(folded.last_row, 1);
  const LabelRegion straight = region_of({{0, 2}, {1, 2}, {7, 2}}, false);
  EXPECT_EQ(straight.first_row, 0);
  EXPECT_EQ(straight.last_row, 7);
  const LabelRegion scattered = region_of({{0, 2}, {5, 2}, {7, 2}}, true);  // round the widest gap, that of 1 to 4
  EXPECT_EQ(scattered.first_row, 5);
  EXPECT_EQ(scattered.last_row, 0);
  const LabelRegion half_way = region_of({{0, 2}, {4, 2}}, true);  // equal gaps: not over the end
  EXPECT_EQ(half_way.first_row, 0);
  EXPECT_EQ(half_way.last_row, 4);
}

TEST(Cells, OneCellIsABoxOfItsOwn) {
  const LabelRegion region = region_of({{6, 4}}, true);
  EXPECT_EQ(region.first_row, 6);
  EXPECT_EQ(region.last_row, 6);
  EXPECT_EQ(region.first_column, region.last_column);
}

TEST(Cells, EachLabelHasItsCellsAndThePeakOfItsOwnPower) {
  const MapShape shape{2, 3, true};
  const std::vector<int16_t> label{0, 1, kNoLabel, 1, 0, 0};
  const std::vector<double> power{1, 3, 90, 4, 5, 5};
  const std::vector<LabelRegion> regions = label_regions(label, power, 3, shape);
  EXPECT_EQ(regions[0].num_cells, 3);
  EXPECT_EQ(regions[0].peak_row * 3 + regions[0].peak_column, 4);
  EXPECT_EQ(regions[0].peak_power, 5.0);
  EXPECT_EQ(regions[1].num_cells, 2);
  EXPECT_EQ(regions[1].peak_row * 3 + regions[1].peak_column, 3);
  EXPECT_EQ(regions[1].peak_power, 4.0);
  EXPECT_EQ(regions[2].num_cells, 0);
}

TEST(Cells, RegionsRefuseLabelsThatNameNothing) {
  const MapShape shape{1, 2, false};
  EXPECT_THROW(label_regions(std::vector<int16_t>{0, 1}, std::vector<double>{1, 1}, 1, shape), std::invalid_argument);
  EXPECT_THROW(label_regions(std::vector<int16_t>{0}, std::vector<double>{1, 1}, 1, shape), std::invalid_argument);
  EXPECT_THROW(label_regions(std::vector<int16_t>{0, 0}, std::vector<double>{1}, 1, shape), std::invalid_argument);
  EXPECT_TRUE(label_regions(std::vector<int16_t>{-1, -1}, std::vector<double>{1, 1}, 0, shape).empty());
}

TEST(Cells, TheNumberOfThreadsChangesNoBit) {
  const std::vector<double> power = random_powers(3 * 50'000);
  const std::vector<uint8_t> all(50'000, 1);
  test::same_on_any_threads([&] { return power_shares(power, 3); });
  test::same_on_any_threads([&] { return strongest_part(power, 3, all); });
}

}  // namespace
}  // namespace echopath::test_cells
