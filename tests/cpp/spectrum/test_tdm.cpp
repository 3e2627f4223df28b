#include <gtest/gtest.h>

#include <algorithm>

#include "echopath/spectrum/array/element_reader.h"
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

TEST(Tdm, IdleTimesCountAsTheyComeBetweenTheSlots) {
  Radar radar = testing::line_radar(1);
  radar.transmitters.resize(3, radar.transmitters.front());
  radar.waveform.chirp_interval = 30e-6;
  radar.waveform.extra_idle = {4e-6, 0.0, 11e-6};
  const std::vector<double> delays = slot_delays(radar);
  EXPECT_EQ(delays[0], 0.0);
  EXPECT_NEAR(delays[1], 34e-6, 1e-18);
  EXPECT_NEAR(delays[2], 64e-6, 1e-18);
  // Every second slot waits: of two chirps in a row one transmitter is late by 30 us and by 40 us.
  radar.waveform.extra_idle = {0.0, 10e-6};
  EXPECT_NEAR(slot_delays(radar)[1], 35e-6, 1e-18);
  EXPECT_NEAR(slot_delays(radar)[2], 70e-6, 1e-18);
}

TEST(Tdm, CarriersThatDifferTurnAnEchoByItsDelay) {
  Radar radar = testing::line_radar(1);
  radar.transmitters.resize(2, radar.transmitters.front());
  EXPECT_TRUE(carrier_phasors(radar, {30.0}).empty());
  radar.waveform.frequency_steps = {0.0, 1e6};
  const auto phasors = carrier_phasors(radar, {0.0, 30.0});
  EXPECT_EQ(phasors[1], Complex(1.0));
  EXPECT_EQ(phasors[2], Complex(1.0));
  EXPECT_NEAR(std::arg(phasors[3]), -1.257507, kLastDigit);  // 0.2001385 turns: 60 m at 1 MHz
  radar.waveform.frequency_steps = {2e6, 3e6};               // the phases are over those of the first transmitter
  const auto above_first = carrier_phasors(radar, {0.0, 30.0});
  EXPECT_EQ(above_first[1], Complex(1.0));
  EXPECT_NEAR(std::arg(above_first[3]), -1.257507, kLastDigit);
  // A wider sweep has a higher carrier in its middle.
  radar.waveform.frequency_steps = {};
  radar.waveform.bandwidth_steps = {0.0, 1e6};
  const double middle = 0.5 * (radar.waveform.num_samples - 1) / radar.waveform.num_samples;
  EXPECT_NEAR(std::arg(carrier_phasors(radar, {0.0, 30.0})[3]), -1.257507 * middle, kLastDigit);
  radar.waveform.bandwidth_steps = {0.0, 1e6, 2e6};  // those of a transmitter change from chirp to chirp
  EXPECT_TRUE(carrier_phasors(radar, {30.0}).empty());
  radar.waveform.bandwidth_steps = {0.0, 1e6};
  radar.multiplexing = Multiplexing::kDdm;
  EXPECT_TRUE(carrier_phasors(radar, {30.0}).empty());
}

TEST(Tdm, CarriersAreThoseOfTheRangesThatAreRead) {
  Radar radar = testing::radar_with({Vec3::Zero(), Vec3(0.0, 0.004, 0.0)}, {Vec3::Zero()}, 8, 16);
  radar.waveform.frequency_steps = {0.0, 1e6};
  RangeDoppler map = testing::empty_map(radar);
  const int64_t still = std::ranges::find(map.velocity, 0.0) - map.velocity.begin();
  const auto num_velocities = std::ssize(map.velocity), num_ranges = std::ssize(map.range);
  ASSERT_LT(still, num_velocities);
  for (int64_t range = 0; range < num_ranges; ++range) {
    map.values[still * num_ranges + range] = 1.0;
    const double delay = 2.0 * map.range[range] / kSpeedOfLight;
    map.values[(num_velocities + still) * num_ranges + range] = std::polar(1.0, kTwoPi * 1e6 * delay);
  }
  const VirtualArray array = virtual_array(radar);
  const ElementReader reader(map, array, radar, Overlaps::kAverage, true);
  Eigen::MatrixXcd values(2, 3);
  reader.read(still, num_ranges - 3, 3, values);
  for (const Complex value : values.reshaped()) EXPECT_NEAR(std::abs(value - 1.0), 0.0, kRounding);
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
