#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "cpp/support/expect_error.h"
#include "cpp/support/waveforms.h"
#include "echopath/radar/radar.h"

namespace echopath::test_radar {
namespace {

using testing::reference_waveform;

constexpr double kRounding = 1e-12;      // relative, a handful of double operations
constexpr double kLastDigit = 1e-3;      // of figures printed with five digits
constexpr double kTimeRounding = 1e-18;  // s, of some milliseconds

Radar one_by_one() {
  Radar radar;
  radar.waveform = reference_waveform();
  radar.transmitters.resize(1);
  radar.receivers.resize(1);
  return radar;
}

// A value is invalid, and the error begins with the field at fault.
template <class Value>
void expect_refused(const Value& value, const std::string& field) {
  const std::string message = test::error_text([&] { value.validate(); });
  EXPECT_TRUE(message.starts_with(field + ": ")) << field << ": " << message;
}

// Published axes of the reference radar, to their printed digits.
TEST(ChirpSequence, DerivedAxesOfTheReferenceRadar) {
  const ChirpSequence w = reference_waveform();
  EXPECT_NEAR(w.range_resolution(), 0.14990, 0.01 * kLastDigit);
  EXPECT_NEAR(w.max_range(), 76.747, kLastDigit);
  EXPECT_NEAR(w.velocity_resolution(1), 0.5037, 0.1 * kLastDigit);
  EXPECT_NEAR(w.max_velocity(1), 32.236, kLastDigit);
  EXPECT_NEAR(w.max_velocity(3), 32.236 / 3, kLastDigit);
  EXPECT_NEAR(w.slope(), 1e9 / 25.6e-6, 1e9 / 25.6e-6 * kRounding);
  EXPECT_NEAR(w.wavelength(), 299792458.0 / 77.5e9, kRounding * w.wavelength());
  EXPECT_NEAR(w.window_centre(), 511 / 40e6, kTimeRounding);
}

TEST(ChirpSequence, RealSamplesHalveTheRange) {
  ChirpSequence w = reference_waveform();
  w.real = true;
  EXPECT_NEAR(w.max_range(), 0.5 * reference_waveform().max_range(), kRounding);
}

TEST(ChirpSequence, AChirpMayFillItsSlot) {
  ChirpSequence w = reference_waveform();
  w.chirp_interval = w.chirp_duration();
  EXPECT_NO_THROW(w.validate());
}

// Lists of steps repeat, each by its own length: chirp by chirp, until both begin anew together.
TEST(ChirpSequence, TheBandIsThatOfAllChirps) {
  const std::vector<double> up = {-0.1e9, 0.3e9, -0.4e9, 0.2e9, 0.5e9, 0.1e9};
  const std::vector<double> wider = {0.1e9, -0.2e9, 0.3e9, 0.4e9, -0.3e9, 0.2e9};
  ChirpSequence w = reference_waveform();
  for (size_t half = 0; half <= 2 * up.size() + 1; ++half) {
    const size_t starts = half / 2;
    w.bandwidth = half % 2 == 0 ? 1e9 : -1e9;
    for (size_t widths = 0; widths <= wider.size(); ++widths) {
      w.frequency_steps.assign(up.begin(), up.begin() + static_cast<std::ptrdiff_t>(starts));
      w.bandwidth_steps.assign(wider.begin(), wider.begin() + static_cast<std::ptrdiff_t>(widths));
      double lowest = std::numeric_limits<double>::infinity(), highest = 0.0;
      for (size_t chirp = 0; chirp < up.size() * wider.size(); ++chirp) {
        const double start = w.start_frequency + (starts > 0 ? up[chirp % starts] : 0.0);
        const double end = start + w.bandwidth + (widths > 0 ? wider[chirp % widths] : 0.0);
        lowest = std::min({lowest, start, end});
        highest = std::max({highest, start, end});
      }
      EXPECT_NEAR(w.band().lowest, lowest, kRounding * lowest) << starts << " " << widths;
      EXPECT_NEAR(w.band().highest, highest, kRounding * highest) << starts << " " << widths;
    }
  }
}

TEST(ChirpSequence, EachBadFieldIsNamed) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const std::vector<std::pair<std::string, std::function<void(ChirpSequence&)>>> cases = {
      {"start_frequency", [](auto& w) { w.start_frequency = 0.0; }},
      {"start_frequency", [=](auto& w) { w.start_frequency = nan; }},
      {"bandwidth", [](auto& w) { w.bandwidth = 0.0; }},
      {"bandwidth", [](auto& w) { w.bandwidth = -77e9; }},
      {"bandwidth_steps", [](auto& w) { w.bandwidth_steps = {0.0, -2e9}; }},
      {"bandwidth", [=](auto& w) { w.bandwidth = inf; }},
      {"num_samples", [](auto& w) { w.num_samples = 0; }},
      {"sampling_rate", [](auto& w) { w.sampling_rate = 0.0; }},
      {"num_chirps", [](auto& w) { w.num_chirps = 0; }},
      {"chirp_interval", [=](auto& w) { w.chirp_interval = nan; }},
      {"chirp_interval", [](auto& w) { w.chirp_interval = 25e-6; }},  // shorter than 512 samples at 20 MHz
  };
  for (const auto& [field, spoil] : cases) {
    ChirpSequence w = reference_waveform();
    spoil(w);
    expect_refused(w, field);
  }
}

TEST(AntennaPattern, CosinePowerIsLossless) {
  for (const double exponent : {0.0, 1.0, 2.5, 12.0}) {
    const AntennaPattern pattern = AntennaPattern::cosine_power(exponent);
    constexpr int kSteps = 20000;
    double sum = 0.0;  // integral of the gain over the sphere, midpoint rule in cos theta
    for (int i = 0; i < kSteps; ++i) sum += pattern.gain(-1.0 + 2.0 * (i + 0.5) / kSteps) * 2.0 / kSteps;
    EXPECT_NEAR(sum, 2.0, 1e-4) << exponent;  // 4 pi / 2 pi; midpoint error (2 / kSteps)^2 and the edge
  }
}

TEST(AntennaPattern, CosinePowerIsDarkBehindAndPeaksAhead) {
  const AntennaPattern pattern = AntennaPattern::cosine_power(2.0, 5.0);
  EXPECT_EQ(pattern.gain(1.0), 5.0);
  EXPECT_NEAR(pattern.gain(std::cos(1.0)), 5.0 * std::pow(std::cos(1.0), 2), kRounding);
  EXPECT_EQ(pattern.gain(0.0), 0.0);
  EXPECT_EQ(pattern.gain(-0.5), 0.0);
  EXPECT_EQ(AntennaPattern::isotropic(0.3).gain(-1.0), 0.3);
}

TEST(AntennaPattern, BadValuesAreErrors) {
  EXPECT_THROW(AntennaPattern::isotropic(0.0), std::invalid_argument);
  EXPECT_THROW(AntennaPattern::cosine_power(-1.0), std::invalid_argument);
  EXPECT_THROW(AntennaPattern::cosine_power(1.0, std::nan("")), std::invalid_argument);
  // More than an antenna without losses has: 1 in every direction, 2 (exponent + 1) ahead of a cosine (as GainTable).
  EXPECT_THROW(AntennaPattern::isotropic(1.1), std::invalid_argument);
  EXPECT_THROW(AntennaPattern::cosine_power(2.0, 6.2), std::invalid_argument);
  EXPECT_NO_THROW(AntennaPattern::cosine_power(2.0, 6.0));
}

TEST(Radar, EachBadFieldIsNamed) {
  const std::vector<std::pair<std::string, std::function<void(Radar&)>>> cases = {
      {"bandwidth", [](Radar& r) { r.waveform.bandwidth = 0.0; }},
      {"transmitters", [](Radar& r) { r.transmitters.clear(); }},
      {"receivers", [](Radar& r) { r.receivers.clear(); }},
      {"transmit_power", [](Radar& r) { r.transmit_power = 0.0; }},
      {"noise_figure_db", [](Radar& r) { r.noise_figure_db = -1.0; }},
      {"transmitters[0].position", [](Radar& r) { r.transmitters[0].position.x() = std::nan(""); }},
      {"receivers[1].polarization",
       [](Radar& r) {
    r.receivers.resize(2);
    r.receivers[1].polarization = Vec3(0, 0, 2);
  }},
      {"receivers[0].orientation", [](Radar& r) { r.receivers[0].orientation.coeffs() *= 1.01; }},
      {"position", [](Radar& r) { r.position.y() = std::nan(""); }},
      {"position", [](Radar& r) { r.position.x() = 1e20; }},  // beyond what rays reach
      {"transmitters[0].position", [](Radar& r) { r.transmitters[0].position.z() = -1e20; }},
      {"yaw", [](Radar& r) { r.yaw = std::numeric_limits<double>::infinity(); }},
      {"pitch", [](Radar& r) { r.pitch = 1.6; }},  // more than straight up
      {"pitch", [](Radar& r) { r.pitch = std::nan(""); }},
  };
  EXPECT_NO_THROW(one_by_one().validate());
  for (const auto& [field, spoil] : cases) {
    Radar radar = one_by_one();
    spoil(radar);
    expect_refused(radar, field);
  }
}

TEST(Radar, SlotsOfTransmittersAlternate) {
  Radar radar = one_by_one();
  radar.transmitters.resize(3);
  const double centre = 511 / 40e6;
  EXPECT_NEAR(radar.chirp_time(0, 0), centre, kTimeRounding);
  EXPECT_NEAR(radar.chirp_time(2, 0), 60e-6 + centre, kTimeRounding);
  EXPECT_NEAR(radar.chirp_time(1, 5), 16 * 30e-6 + centre, kTimeRounding);
  EXPECT_NEAR(radar.frame_duration(), (3 * 128 - 1) * 30e-6 + 511 / 20e6, kTimeRounding);
  EXPECT_THROW(radar.chirp_time(3, 0), std::out_of_range);
  EXPECT_THROW(radar.chirp_time(0, 128), std::out_of_range);
}

TEST(Radar, MotionCarriesTheRadar) {
  Radar radar = one_by_one();
  EXPECT_TRUE(radar.world_from_radar(0.5).isApprox(Transform::Identity()));
  radar.motion = std::make_shared<LinearMotion>(Vec3(2, 0, 0));
  EXPECT_NEAR((radar.world_from_radar(0.5) * Vec3(0, 1, 0) - Vec3(1, 1, 0)).norm(), 0.0, kRounding);
}

// Yaw turns to the left, pitch looks up, and the axis to the left stays level: closed forms of spherical coordinates.
TEST(Radar, PositiveYawLooksLeftAndPositivePitchLooksUp) {
  constexpr double kYaw = 0.7, kPitch = 0.3;
  const Quaternion turn = turned(kYaw, kPitch);
  const double cos_yaw = std::cos(kYaw), sin_yaw = std::sin(kYaw), cos_pitch = std::cos(kPitch),
               sin_pitch = std::sin(kPitch);
  EXPECT_NEAR((turn * Vec3::UnitX() - Vec3(cos_pitch * cos_yaw, cos_pitch * sin_yaw, sin_pitch)).norm(), 0.0, kRounding);
  EXPECT_NEAR((turn * Vec3::UnitY() - Vec3(-sin_yaw, cos_yaw, 0.0)).norm(), 0.0, kRounding);
  EXPECT_NEAR((turn * Vec3::UnitZ() - Vec3(-sin_pitch * cos_yaw, -sin_pitch * sin_yaw, cos_pitch)).norm(), 0.0, kRounding);
}

// The velocity is in the axes of the world, whichever way the radar looks, and the radar turns about its own origin.
TEST(Radar, MotionMovesThePlacedRadar) {
  Radar radar = one_by_one();
  radar.position = Vec3(10, -2, 1.5);
  radar.yaw = 0.5 * std::numbers::pi;
  EXPECT_NEAR((radar.world_from_radar(3.0) * Vec3(1, 0, 0) - Vec3(10, -1, 1.5)).norm(), 0.0, kRounding);
  radar.motion = std::make_shared<LinearMotion>(Vec3(2, 0, 0), Vec3(0, 0, 0.5 * std::numbers::pi));
  const Transform after_a_second = radar.world_from_radar(1.0);  // went on by 2 m along x, looks along -x
  EXPECT_NEAR((after_a_second.translation() - Vec3(12, -2, 1.5)).norm(), 0.0, kRounding);
  EXPECT_NEAR((after_a_second * Vec3(1, 0, 0) - Vec3(11, -2, 1.5)).norm(), 0.0, kRounding);
  EXPECT_NEAR((after_a_second * Vec3(0, 1, 0) - Vec3(12, -3, 1.5)).norm(), 0.0, kRounding);
}

// Turning the antenna in the radar's frame after the radar in the world is a product of matrices written out by hand.
TEST(Radar, PitchIsAboutTheTurnedAxisAlsoWhileItTurns) {
  Radar radar = one_by_one();
  radar.yaw = 0.4, radar.pitch = -0.2;
  radar.motion = std::make_shared<LinearMotion>(Vec3(0, 1, 0), Vec3(0, 0, 0.3));
  Mat3 about_z, about_y;  // by 0.3 * 2 + 0.4 rad to the left, then 0.2 rad nose down
  about_z << std::cos(1.0), -std::sin(1.0), 0, std::sin(1.0), std::cos(1.0), 0, 0, 0, 1;
  about_y << std::cos(0.2), 0, std::sin(0.2), 0, 1, 0, -std::sin(0.2), 0, std::cos(0.2);
  EXPECT_NEAR((radar.world_from_radar(2.0).linear() - about_z * about_y).norm(), 0.0, kRounding);
}

}  // namespace
}  // namespace echopath::test_radar
