#include <gtest/gtest.h>

#include "echopath/spectrum/array/tdm.h"
#include "plane_waves.h"

namespace echopath::test_tdm {
namespace {

using testing::Complex;
constexpr double kRounding = 1e-12;
constexpr double kLastDigit = 1e-6;  // rad, as printed

TEST(Tdm, TenMetresPerSecondTurnASlotByItsPublishedPhase) {
  Radar radar = testing::line_radar(1);
  radar.transmitters.resize(3, radar.transmitters.front());
  const auto phasors = slot_phasors(radar, {10.0});
  EXPECT_NEAR(std::arg(phasors[1]), -0.974568, kLastDigit);
  EXPECT_NEAR(std::arg(phasors[2]), -2 * 0.974568, 2 * kLastDigit);
}

TEST(Tdm, TransmittersThatSendAtOnceHaveNoPhaseBetweenThem) {
  Radar radar = testing::line_radar(1);
  radar.transmitters.resize(3, radar.transmitters.front());
  radar.multiplexing = Multiplexing::kDdm;
  for (const Complex phasor : slot_phasors(radar, {10.0, -3.0})) EXPECT_EQ(phasor, Complex(1.0));
}

TEST(Tdm, CompensationLeavesThePhaseOfDirectionOnly) {
  const Vec3 u = direction(0.3, 0.1);
  for (const int fold : {0, 1, -1}) {
    const Radar radar = testing::radar_with(testing::line(3, {0, 0.004, 0}), testing::line(2, {0, 0.002, 0}));
    RangeDoppler moving = testing::empty_map(radar), still = moving;
    testing::add_wave(moving, radar, u, {1.0, 0.5}, 6, 1, true, fold);
    testing::add_wave(still, radar, u, {1.0, 0.5}, 6, 1, false);
    const RangeDoppler map = compensate_tdm(moving, radar, fold);
    EXPECT_TRUE(map.is_tdm_compensated);
    for (size_t i = 0; i < map.values.size(); ++i) EXPECT_NEAR(std::abs(map.values[i] - still.values[i]), 0.0, kRounding);
    // lambda / (4 M Td) each way
    EXPECT_NEAR(map.velocity[6] - moving.velocity[6], fold * testing::wavelength() / (2 * 3 * 30e-6), kRounding);
  }
}

TEST(Tdm, OneTransmitterNeedsNoCompensation) {
  const Radar radar = testing::line_radar(3);
  RangeDoppler map = testing::empty_map(radar);
  testing::add_wave(map, radar, direction(0.3, 0.0), 1.0, 1, 2);
  EXPECT_EQ(compensate_tdm(map, radar).values, map.values);
}

TEST(Tdm, BadInputIsAnError) {
  const Radar radar = testing::line_radar(3);
  const RangeDoppler map = testing::empty_map(radar);
  EXPECT_THROW(compensate_tdm(compensate_tdm(map, radar), radar), std::invalid_argument);
  EXPECT_THROW(compensate_tdm(map, testing::line_radar(2)), std::invalid_argument);
  EXPECT_THROW(compensate_tdm(map, radar, 1001), std::invalid_argument);
  RangeDoppler broken = map;
  broken.values.pop_back();
  EXPECT_THROW(compensate_tdm(broken, radar), std::invalid_argument);
  EXPECT_THROW(compensate_tdm(RangeDoppler{}, radar), std::invalid_argument);
  Job job;
  job.cancel();
  EXPECT_THROW(compensate_tdm(map, radar, 0, &job), Cancelled);
}

}  // namespace
}  // namespace echopath::test_tdm
