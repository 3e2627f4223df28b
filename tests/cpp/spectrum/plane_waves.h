#pragma once
// Arrays, and maps of plane waves on them written down cell by cell from the definition of the signal:
// L = L0 - x.u  ->  s ~ e^{-jk x.u} for both legs, and e^{+j 2 pi f_D m Td} in slot m.
#include <cmath>
#include <complex>
#include <vector>

#include "echopath/base/constants.h"
#include "echopath/spectrum/array/steering.h"
#include "echopath/spectrum/range_doppler.h"

namespace echopath::testing {

using Complex = std::complex<double>;

inline constexpr double kDegree = kPi / 180.0;

inline Radar radar_with(const std::vector<Vec3>& transmitters, const std::vector<Vec3>& receivers, int num_chirps = 8,
                        int num_samples = 4) {
  Radar radar;
  radar.waveform = {.start_frequency = 77e9,
                    .bandwidth = 1e9,
                    .num_samples = num_samples,
                    .sampling_rate = 20e6,
                    .num_chirps = num_chirps,
                    .chirp_interval = 30e-6,
                    .real = false};
  for (const Vec3& position : transmitters) radar.transmitters.emplace_back().position = position;
  for (const Vec3& position : receivers) radar.receivers.emplace_back().position = position;
  return radar;
}

// Nine receivers on a circle, which is no grid; symmetric about nothing.
inline Radar circle_radar() {
  std::vector<Vec3> circle;
  for (int i = 0; i < 9; ++i) circle.emplace_back(0.0, 0.01 * std::cos(0.7 * i), 0.01 * std::sin(0.7 * i));
  return radar_with({Vec3::Zero()}, circle);
}

// `count` positions along `step`.
inline std::vector<Vec3> line(int count, const Vec3& step, const Vec3& first = Vec3::Zero()) {
  std::vector<Vec3> positions;
  for (int i = 0; i < count; ++i) positions.push_back(first + i * step);
  return positions;
}

inline double wavelength() { return 299792458.0 / 77.5e9; }

// An N-element line of half-wavelength steps along y.
inline Radar line_radar(int count, int num_chirps = 8, int num_samples = 4) {
  return radar_with({Vec3::Zero()}, line(count, Vec3(0.0, 0.5 * wavelength(), 0.0)), num_chirps, num_samples);
}

// A map of zeros with the axes of the radar's.
inline RangeDoppler empty_map(const Radar& radar) {
  RangeDoppler map;
  map.window = Window{WindowKind::kRect};
  map.num_transmitters = static_cast<int>(radar.transmitters.size());
  map.num_receivers = static_cast<int>(radar.receivers.size());
  map.velocity = velocity_axis(radar.waveform, radar.num_slots(), radar.waveform.num_chirps);
  map.range = range_axis(radar.waveform, radar.waveform.num_samples);
  map.values.resize(map.num_transmitters * map.num_receivers * map.velocity.size() * map.range.size());
  return map;
}

// Adds a wave of `amplitude` from a direction to one cell; moving: with the phase that the cell's velocity plus
// fold turns of the axis adds between slots.
inline void add_wave(RangeDoppler& map, const Radar& radar, const Vec3& u, Complex amplitude, size_t velocity, size_t range,
                     bool moving = true, double fold = 0.0) {
  const double k = kTwoPi / radar.waveform.wavelength();
  const double v = map.velocity[velocity] + fold * 2.0 * radar.waveform.max_velocity(radar.num_slots());
  for (size_t tx = 0; tx < radar.transmitters.size(); ++tx) {
    for (size_t rx = 0; rx < radar.receivers.size(); ++rx) {
      const double path = (radar.transmitters[tx].position + radar.receivers[rx].position).dot(u);
      const double slot = moving ? 2.0 * k * v * static_cast<double>(tx) * radar.waveform.chirp_interval : 0.0;
      const size_t row = (tx * radar.receivers.size() + rx) * map.velocity.size() + velocity;
      map.values[row * map.range.size() + range] += amplitude * std::polar(1.0, slot - k * path);
    }
  }
}

}  // namespace echopath::testing
