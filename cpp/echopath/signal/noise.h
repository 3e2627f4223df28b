#pragma once
// Thermal noise of the receiver: the only home of noise.
#include <complex>
#include <cstdint>
#include <vector>

#include "echopath/base/job.h"
#include "echopath/radar/radar.h"

namespace echopath {

// Noise power of one IF sample, W: k T0 F fs for complex samples, half of it for real ones (single-sideband noise
// figure, no image).
double noise_power(const Radar& radar);

// Noise power in the range-Doppler cell that all samples of a frame make with even weights, W, against the received power of
// an echo there: that of a sample over their number, twice as much for real samples, whose maps hold half of their power.
double noise_power_in_cell(const Radar& radar);

// Adds circular complex Gaussian noise to the cube [tx, rx, chirp, sample] (real samples: real Gaussian noise),
// independent from sample to sample. A pure function of (seed, place in the cube), so it depends on no thread.
// Parallel over chirps.
// Raises invalid_argument unless the cube has the size that the radar gives it, Cancelled when the job is.
void add_noise(std::vector<std::complex<double>>& cube, const Radar& radar, uint64_t seed, Job* job = nullptr);
// The same for the `size` samples at `cube`.
void add_noise(std::complex<double>* cube, int64_t size, const Radar& radar, uint64_t seed, Job* job = nullptr);

// Samples in the cube of a radar: transmitters x receivers x chirps x samples.
int64_t cube_size(const Radar& radar);

}  // namespace echopath
