#include "call/plausible.h"

#include <algorithm>
#include <cmath>

#include "call/warn.h"
#include "echopath/base/constants.h"
#include "echopath/base/errors.h"
#include "echopath/base/text/streamed.h"

namespace echopath::bindings {
namespace {

constexpr double kNarrowest = 5e3;              // Hz, cells of 30 km: less than radars beyond the horizon have
constexpr double kLeastBandwidth = 1e-3;        // Hz, below which ranges overflow
constexpr double kLargestInterval = 1e6;        // s, between chirps
constexpr double kLargestPower = 1e30;          // W, whose squares are finite
constexpr double kLargestNoiseFigure = 1000.0;  // dB, likewise
constexpr double kLongestInterval = 1.0;        // s
constexpr double kTurn = 2.0 * kPi + 1e-9;      // rad

template <class... Words>
void warn(const Words&... words) {
  warn_caller(streamed(words...));
}

void require_below_infrared(const ChirpSequence& waveform, double step, const char* argument, double value) {
  require(waveform.start_frequency + std::max(waveform.bandwidth, 0.0) + step <= kHighestFrequency, argument,
          "must leave frequencies up to 1e14 Hz (1 GHz is 1e9)", value);
}

}  // namespace

void require_plausible(const ChirpSequence& waveform) {
  require(waveform.start_frequency >= kLowestFrequency, "start_frequency", "must be at least 1e6 Hz (77 GHz are 77e9)",
          waveform.start_frequency);
  require(waveform.start_frequency <= kHighestFrequency, "start_frequency", "must be at most 1e14 Hz (77 GHz are 77e9)",
          waveform.start_frequency);
  require_below_infrared(waveform, 0.0, "bandwidth", waveform.bandwidth);
  const double width = std::abs(waveform.bandwidth);
  require(width >= kLeastBandwidth, "bandwidth",
          "must be at least 1e-3 Hz (1 GHz is 1e9), or at most -1e-3 Hz of chirps that fall", waveform.bandwidth);
  require(waveform.sampling_rate <= kHighestFrequency, "sampling_rate", "must be at most 1e14 Hz (20 MHz are 20e6)",
          waveform.sampling_rate);
  require(waveform.chirp_interval <= kLargestInterval, "chirp_interval", "must be at most 1e6 s (60 us are 60e-6)",
          waveform.chirp_interval);
  for (const double idle : waveform.extra_idle) {
    require(idle <= kLargestInterval, "extra_idle", "must be at most 1e6 s (5 us are 5e-6)", idle);
  }
  for (const double step : waveform.frequency_steps) {
    require(waveform.start_frequency + step >= kLowestFrequency, "frequency_steps", "must leave frequencies from 1e6 Hz on",
            step);
    require_below_infrared(waveform, step, "frequency_steps", step);
  }
  for (const double step : waveform.bandwidth_steps) require_below_infrared(waveform, step, "bandwidth_steps", step);
  require(waveform.band().lowest >= kLowestFrequency, "bandwidth", "must leave frequencies from 1e6 Hz on where chirps fall",
          waveform.bandwidth);
  if (width > waveform.start_frequency) {
    warn("bandwidth: ", waveform.bandwidth, " Hz is more than start_frequency, ", waveform.start_frequency,
         " Hz; are both in Hz?");
  }
  if (width < kNarrowest) {
    warn("bandwidth: ", waveform.bandwidth, " Hz makes range cells of ", waveform.range_resolution() * 1e-3,
         " km; is it in Hz (1 GHz is 1e9)?");
  }
  if (waveform.chirp_interval > kLongestInterval) {
    warn("chirp_interval: ", waveform.chirp_interval, " s from chirp to chirp; is it in s (60 us are 60e-6)?");
  }
}

void require_plausible(const Radar& radar) {
  require(radar.transmit_power <= kLargestPower, "transmit_power", "must be at most 1e30 W", radar.transmit_power);
  require(radar.noise_figure_db <= kLargestNoiseFigure, "noise_figure_db", "must be at most 1000 dB", radar.noise_figure_db);
}

void warn_of_turns(double yaw) {
  if (std::abs(yaw) <= kTurn) return;
  warn("yaw: ", yaw, " rad are ", yaw / (2.0 * kPi), " turns; angles are in rad, ", yaw, " degrees would be ",
       yaw * kPi / 180.0);
}

void require_below_light(double speed, const char* argument) {
  require(std::abs(speed) < kSpeedOfLight, argument, "must be below the speed of light, 299792458 m/s", speed);
}

}  // namespace echopath::bindings
