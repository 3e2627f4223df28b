#pragma once
// Draws the thermal noise of the receiver (radar/noise_power.h has its power); no other module does.
#include <complex>
#include <cstdint>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/radar/noise_power.h"
#include "echopath/radar/radar.h"

namespace echopath {

// Adds circular complex Gaussian noise to the cube [tx, rx, chirp, sample] (real samples: real Gaussian noise), independent
// from sample to sample. It is a pure function of (seed, place in the cube), so it does not depend on threads. It runs in
// parallel over chirps. Raises invalid_argument unless the cube has the size that the radar gives it; raises Cancelled when
// the job is cancelled.
void add_noise(std::vector<std::complex<double>>& cube, const Radar& radar, uint64_t seed, Job* job = nullptr);

// Returns the seed of the noise of the frame that starts at `start_time` (s): frames that start at different times have
// independent noise of one seed, and a frame has the same noise whether it is simulated alone or among others. It is `seed`
// itself for a frame that starts at 0.
uint64_t noise_seed_of_frame(uint64_t seed, double start_time);

// Returns the number of samples in the cube of a radar: transmitters x receivers x chirps x samples.
int64_t cube_size(const Radar& radar);

}  // namespace echopath
