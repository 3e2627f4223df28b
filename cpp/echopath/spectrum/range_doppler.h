#pragma once
// Computes range-Doppler maps.
#include <complex>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/radar/radar.h"
#include "echopath/spectrum/window.h"

namespace echopath {

inline constexpr int kMaxZeroPad = 64;  // of all transforms

struct RangeDoppler {
  int num_transmitters = 0, num_receivers = 0;
  std::vector<double> velocity;              // [V] m/s, ascending, receding positive
  std::vector<double> range;                 // [R] m, ascending from 0
  std::vector<std::complex<double>> values;  // [tx, rx, V, R] sqrt(W): |peak|^2 is received power
  MapWindows window;
  int zero_pad = 1;                 // 1 to kMaxZeroPad
  bool is_tdm_compensated = false;  // whether the phase between TDM slots has been taken out
};

// Returns the range of each bin for `num_bins` samples after padding, R = c f_b / (2 slope): all bins, or the lower half
// for real samples.
std::vector<double> range_axis(const ChirpSequence& waveform, int num_bins);
// Returns the velocity of each bin for `num_bins` chirps after padding, v = f_D lambda / 2 at the centre frequency;
// num_slots transmitters share the time. Bin num_bins / 2 is at rest.
std::vector<double> velocity_axis(const ChirpSequence& waveform, int num_slots, int num_bins);

// Applies the windowed Fourier transform to the cube [tx, rx, chirp, sample] over samples and chirps, both padded to
// zero_pad times their number, and divides by the window sums (real samples: times sqrt 2, beat frequencies of the slope's
// sign only). The Doppler phase between TDM slots is left in. Runs in parallel over rows; the result does not depend on the
// threads. Raises invalid_argument on a cube of another size than the radar's, or unless 1 <= zero_pad <= 64.
RangeDoppler range_doppler(const std::vector<std::complex<double>>& cube, const Radar& radar, const MapWindows& window = {},
                           int zero_pad = 1, Job* job = nullptr);

// Transforms the samples of one channel after the other, as range_doppler does those of all: with plans and tapers that
// are made once, and without a parallel loop. Several threads may use it.
class MapTransform {
 public:
  // Raises as range_doppler.
  MapTransform(const Radar& radar, const MapWindows& window, int zero_pad);
  ~MapTransform();
  int64_t num_velocities() const;
  int64_t num_ranges() const;
  // Transforms samples [chirp, sample] to values [V, R] in sqrt(W). `profiles` is memory for the range profiles. Ranges
  // whose `asked` [R] is 0 may be left as they are; an empty `asked` asks for all.
  void transform(const std::complex<double>* samples, std::vector<std::complex<double>>& profiles,
                 std::complex<double>* values, std::span<const uint8_t> asked = {}) const;
  // Adds the power at each range of a chirp that is like all others, [sample], to `power`, [R] in W.
  void add_still(const std::complex<double>* samples, std::vector<double>& power) const;
  // Adds to `cells` [V, R] in W what such powers are at each velocity.
  void spread_still(const std::vector<double>& power, double* cells) const;

 private:
  struct Plan;
  std::unique_ptr<const Plan> plan_;
};

// Returns the mean of |value|^2 over the channels, [V, R] in W.
std::vector<double> mean_power(const RangeDoppler& map, Job* job = nullptr);

// Returns the mean power of white noise in a cell of a map, W: sample_power ENBW_range ENBW_velocity/(num_samples
// num_chirps) with the equivalent noise bandwidths of the windows (Harris 1978); padding does not change it. sample_power
// (W) is that of complex samples; give twice that of real ones, because a map holds their positive frequencies times sqrt
// 2.
double cell_noise_power(double sample_power, const ChirpSequence& waveform, const MapWindows& window);

}  // namespace echopath
