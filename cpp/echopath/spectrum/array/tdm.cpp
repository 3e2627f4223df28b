#include "echopath/spectrum/array/tdm.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include "echopath/base/constants.h"
#include "echopath/base/errors.h"
#include "echopath/base/threads/parallel.h"

namespace echopath {
namespace {

constexpr int kMaxFold = 1000;
constexpr double kAxisRounding = 1e-9;  // relative, of the ends of an axis

bool is_alike(double a, double b) { return std::abs(a - b) <= kAxisRounding * std::max(std::abs(a), std::abs(b)); }

// Returns whether a list of steps, repeated from slot to slot, gives all chirps of a transmitter the same one.
bool repeats_with(const std::vector<double>& steps, size_t num_tx) {
  for (size_t slot = 0; slot < steps.size(); ++slot) {
    if (steps[slot] != steps[(slot + num_tx) % steps.size()]) return false;
  }
  return true;
}

double repeated(const std::vector<double>& steps, size_t slot) { return steps.empty() ? 0.0 : steps[slot % steps.size()]; }

}  // namespace

std::vector<double> slot_delays(const Radar& radar) {
  const auto num_tx = static_cast<int64_t>(radar.transmitters.size());
  std::vector<double> delays(radar.transmitters.size(), 0.0);
  if (!radar.takes_turns()) return delays;
  const ChirpSequence& waveform = radar.waveform;
  // Where idle times do not repeat with the transmitters, the chirps of one of them are late by different times.
  const bool is_even = waveform.extra_idle.empty() || num_tx % static_cast<int64_t>(waveform.extra_idle.size()) == 0;
  const int64_t num_chirps = is_even ? 1 : waveform.num_chirps;
  for (int64_t tx = 0; tx < num_tx; ++tx) {
    double sum = 0.0;
    for (int64_t chirp = 0; chirp < num_chirps; ++chirp) {
      sum += waveform.slot_start(chirp * num_tx + tx) - waveform.slot_start(chirp * num_tx);
    }
    delays[tx] = sum / static_cast<double>(num_chirps);
  }
  return delays;
}

std::vector<std::complex<double>> slot_phasors(const Radar& radar, const std::vector<double>& velocity) {
  std::vector<std::complex<double>> phasors;
  for (const double delay : slot_delays(radar)) {
    for (const double v : velocity) {
      phasors.push_back(std::polar(1.0, -2.0 * kTwoPi * v / radar.waveform.wavelength() * delay));
    }
  }
  return phasors;
}

// A map that was compensated may have its velocities shifted.
void require_axes(const RangeDoppler& map, const Radar& radar) {
  const ChirpSequence& waveform = radar.waveform;
  const std::vector<double> range = range_axis(waveform, waveform.num_samples * map.zero_pad);
  const std::vector<double> velocity = velocity_axis(waveform, radar.num_slots(), waveform.num_chirps * map.zero_pad);
  require(map.range.size() == range.size() && is_alike(map.range.back(), range.back()), "spectrum",
          "must have been made with the chirps of this radar, whose last range is " + std::to_string(range.back()) + " m",
          map.range.back());
  const double span = velocity.back() - velocity.front();
  require(map.velocity.size() == velocity.size() && is_alike(map.velocity.back() - map.velocity.front(), span), "spectrum",
          "must have been made with the chirps of this radar, whose velocities span " + std::to_string(span) + " m/s",
          map.velocity.back() - map.velocity.front());
}

void require_map_of(const RangeDoppler& map, const Radar& radar) {
  const int num_tx = static_cast<int>(radar.transmitters.size()), num_rx = static_cast<int>(radar.receivers.size());
  require(map.num_transmitters == num_tx && map.num_receivers == num_rx, "spectrum",
          "must have the radar's " + std::to_string(num_tx) + " x " + std::to_string(num_rx) + " channels",
          std::to_string(map.num_transmitters) + " x " + std::to_string(map.num_receivers));
  const size_t size = size_t{1} * num_tx * num_rx * map.velocity.size() * map.range.size();
  require(size > 0 && map.values.size() == size, "spectrum", "must have channels x velocities x ranges values",
          map.values.size());
  require_axes(map, radar);
}

std::vector<double> carrier_turns(const Radar& radar) {
  const ChirpSequence& waveform = radar.waveform;
  const size_t num_tx = radar.transmitters.size();
  if (!radar.takes_turns() ||
      !(repeats_with(waveform.frequency_steps, num_tx) && repeats_with(waveform.bandwidth_steps, num_tx))) {
    return {};
  }
  const double middle = waveform.window_centre() * waveform.sampling_rate / waveform.num_samples;  // of the sweep
  std::vector<double> turns;
  for (size_t tx = 0; tx < num_tx; ++tx) {
    const double step = repeated(waveform.frequency_steps, tx) + middle * repeated(waveform.bandwidth_steps, tx);
    turns.push_back(2.0 * kTwoPi * step / kSpeedOfLight);
  }
  const double first = turns.front();
  for (double& turn : turns) turn -= first;
  if (std::ranges::all_of(turns, [](double turn) { return turn == 0.0; })) return {};
  return turns;
}

std::vector<std::complex<double>> carrier_phasors(const Radar& radar, const std::vector<double>& range) {
  std::vector<std::complex<double>> phasors;
  for (const double turn : carrier_turns(radar)) {
    for (const double r : range) phasors.push_back(std::polar(1.0, -turn * r));
  }
  return phasors;
}

RangeDoppler compensate_tdm(const RangeDoppler& map, const Radar& radar, int fold, Job* job) {
  radar.validate();
  require_map_of(map, radar);
  require(!map.is_tdm_compensated, "spectrum", "must not have been compensated before", "one that was");
  require(std::abs(fold) <= kMaxFold, "fold", "must be in [-1000, 1000]", fold);
  RangeDoppler result = map;
  result.is_tdm_compensated = true;
  const double span = 2.0 * radar.waveform.max_velocity(radar.num_slots());
  for (double& v : result.velocity) v += fold * span;
  const auto phasors = slot_phasors(radar, result.velocity), carriers = carrier_phasors(radar, result.range);
  const int64_t num_velocities = std::ssize(map.velocity);
  const int64_t num_ranges = std::ssize(map.range);
  parallel_for(map.num_transmitters * map.num_receivers * num_velocities, [&](int64_t row) {
    if (job) job->throw_if_cancelled();
    const int64_t slot = row / (map.num_receivers * num_velocities);
    const std::complex<double> phasor = phasors[slot * num_velocities + row % num_velocities];
    for (int64_t r = 0; r < num_ranges; ++r) {
      result.values[row * num_ranges + r] *= carriers.empty() ? phasor : phasor * carriers[slot * num_ranges + r];
    }
  });
  return result;
}

}  // namespace echopath
