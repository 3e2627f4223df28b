#include "echopath/signal/noise.h"

#include <cmath>
#include <cstring>

#include "echopath/base/constants.h"
#include "echopath/base/errors.h"
#include "echopath/base/random.h"
#include "echopath/base/threads/parallel.h"

namespace echopath {
namespace {

// Draws a circular complex Gaussian with E|n|^2 = 2 (Box and Muller).
std::complex<double> gaussian_pair(uint64_t seed, int64_t index) {
  const auto [u, v] = uniform2(seed, Stream::kNoise, static_cast<uint64_t>(index), 0);
  return std::polar(std::sqrt(-2.0 * std::log1p(-u)), kTwoPi * v);
}

}  // namespace

int64_t cube_size(const Radar& radar) {
  return std::ssize(radar.transmitters) * std::ssize(radar.receivers) * radar.waveform.num_chirps *
         radar.waveform.num_samples;
}

uint64_t noise_seed_of_frame(uint64_t seed, double start_time) {
  if (start_time == 0.0) return seed;
  uint64_t time_bits = 0;
  std::memcpy(&time_bits, &start_time, sizeof time_bits);
  // The noise of samples has counters of dimension 0.
  constexpr uint32_t kFrameDimension = 1;
  const auto words = philox4x32({static_cast<uint32_t>(time_bits), static_cast<uint32_t>(time_bits >> 32), kFrameDimension,
                                 static_cast<uint32_t>(Stream::kNoise)},
                                philox_key(seed));
  return uint64_t{words[0]} << 32 | words[1];
}

void add_noise(std::vector<std::complex<double>>& cube, const Radar& radar, uint64_t seed, Job* job) {
  radar.validate();
  const int64_t size = std::ssize(cube);
  require(size == cube_size(radar), "cube", "must have transmitters x receivers x chirps x samples values", size);
  const bool real = radar.waveform.real;
  const double deviation = std::sqrt(real ? noise_power(radar) : 0.5 * noise_power(radar));
  const int64_t num_samples = radar.waveform.num_samples;
  parallel_for(size / num_samples, [&](int64_t chirp) {
    for (int64_t i = chirp * num_samples; i < (chirp + 1) * num_samples; ++i) {
      const std::complex<double> noise = deviation * gaussian_pair(seed, i);
      cube[i] += real ? noise.real() : noise;
    }
  }, job);
}

}  // namespace echopath
