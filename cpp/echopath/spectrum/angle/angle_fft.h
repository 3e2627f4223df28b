#pragma once
// Computes angle spectra of uniform arrays by Fourier transforms over the rows and columns of their grid.
#include <complex>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/radar/radar.h"
#include "echopath/spectrum/array/element_reader.h"
#include "echopath/spectrum/range_doppler.h"
#include "echopath/spectrum/window.h"

namespace echopath {

struct AngleFftOptions {
  Window window;     // over columns and rows, symmetric (steering.h)
  int zero_pad = 4;  // 1 to 64, for each axis that has more than one point
  Overlaps overlaps = Overlaps::kAverage;
  bool compensate = true;  // take out the phase between TDM slots
};

struct AngleSpectrum {
  // These are direction cosines along the grid's column axis and row axis: sin(azimuth) cos(elevation) and sin(elevation)
  // for antennas in the y-z plane. They ascend from -wavelength / (2 spacing); for one column (row) there is only 0.
  std::vector<double> sin_azimuth;           // [A]
  std::vector<double> sin_elevation;         // [E]
  std::vector<double> velocity;              // [V] m/s, receding positive
  std::vector<double> range;                 // [R] m
  std::vector<std::complex<double>> values;  // [E, A, V, R] sqrt(W), phase as at the array's centre
};

// Returns the arcsin of each direction cosine, rad: the angle from broadside. It is NaN beyond +-1, where no wave comes
// from.
std::vector<double> angles_of(const std::vector<double>& direction_cosine);

// Computes sum_n w_n s_n e^{+j k x_n.u} / sum_n w_n over the elements n of the radar's virtual array, on the grid of
// direction cosines u of a Fourier transform. |value|^2 of a far point is its received power in W, averaged over channels.
// Noise of power P in each channel's cell leaves P sum_n (w_n^2 / c_n) / (sum_n w_n)^2, with c_n channels averaged in
// element n: P / N for N elements without a window. Points of the grid without an element count as zeros of weight 0.
// Runs in parallel over cells; the result does not depend on the number of threads.
// Raises invalid_argument when the map is not the radar's, the array is no grid of equal steps (use `beamform`) or an
// option is out of range.
AngleSpectrum angle_fft(const RangeDoppler& map, const Radar& radar, const AngleFftOptions& options = {},
                        Job* job = nullptr);

}  // namespace echopath
